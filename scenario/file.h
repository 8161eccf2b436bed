// Reading a whole file, and what is said when that or another call for a file fails.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace fogline {

/// What came of it: `error` is empty, or says why `text` is not there.
struct FileText {
  std::string text;
  std::string error;
};

/// `; did you mean "scenario/paper.json"?` for a name of which there is no file: the one in the
/// same folder that is spelt alike. Nothing if there is none.
/// @param ending of every file that may be meant, such as ".json"; "" for any
std::string DidYouMeanFile(const std::filesystem::path& file, std::string_view ending = "");

/// The bytes of a file of at most `max_bytes`, or what comes out of a pipe, such as that of
/// `<(command)` in a shell: up to its end, with no pause longer than 5 s, so that a pipe into
/// which no process writes is not waited for without end. The error of a file that is not there has
/// the name that may be meant, with this ending.
/// @throws std::runtime_error as ThrowIfExhausted()
FileText ReadFile(const std::filesystem::path& file, std::size_t max_bytes,
                  std::string_view ending = "");

/// Why what is there is no file to be read, "" if it is one: for programs that map or seek.
std::string WhyNoRegularFile(const std::filesystem::path& file);

/// A file opened for reading, closed at the end. Opening waits for no process at the other end of a
/// pipe.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& file);
  ~OpenFile();
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  /// -1, and errno says why, if it could not be opened.
  int fd() const { return fd_; }

 private:
  int fd_;
};

/// Writes all bytes to an open file. @return 0, or errno
/// @param stop asked while a pipe or terminal has no room; if it says so, the call ends with EINTR
int WriteAll(int fd, std::string_view bytes, bool (*stop)() = nullptr);

/// For a call that failed because the process or the machine has used up descriptors, memory or
/// disk. Not the input is bad then, but the run fails (exit code 3). Returns if it is something
/// else.
/// @param what such as the file's name
/// @throws std::runtime_error "WHAT: Too many open files; ulimit -n 1024 allows more"
void ThrowIfExhausted(int error, std::string_view what);

}  // namespace fogline
