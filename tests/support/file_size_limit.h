// A limit for the size of files, with which a test simulates a full disk.
#pragma once

#include <sys/resource.h>

#include <csignal>

namespace fogline::test {

/// While an object of this class exists, a write beyond `bytes` bytes of a file fails, in this
/// process and in the processes that it starts.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : bytes_(bytes), handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit shorter{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &shorter);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  rlim_t bytes() const { return bytes_; }

 private:
  rlim_t bytes_;
  void (*handler_)(int);
  rlimit before_{};
};

}  // namespace fogline::test
