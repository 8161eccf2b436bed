// A relay for one run: fogline-relay on a free port of this machine, gone with this object.
#pragma once

#include <sys/types.h>

#include <string>

namespace fogline {

class RelayProcess {
 public:
  /// Starts it and waits until it listens. @throws std::runtime_error
  RelayProcess();
  ~RelayProcess();
  RelayProcess(const RelayProcess&) = delete;
  RelayProcess& operator=(const RelayProcess&) = delete;

  const std::string& url() const { return url_; }

 private:
  pid_t pid_ = -1;
  std::string url_;
};

}  // namespace fogline
