// A fake X screen. A program that looks for a screen finds it, but cannot open windows on it.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace fogline::test {

/// A socket that listens at the address of an X server with a free number.
class Screen {
 public:
  Screen() : fd_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    constexpr int kFirst = 1000;  // real servers have lower numbers
    constexpr int kLast = 9999;
    for (number_ = kFirst; number_ <= kLast; ++number_) {
      if (Bind() && listen(fd_, SOMAXCONN) == 0) return;
    }
    throw std::runtime_error("no number of a screen is free");
  }
  ~Screen() { close(fd_); }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  std::string display() const { return ":" + std::to_string(number_); }

 private:
  bool Bind() const {
    const std::string name = std::string(1, '\0') + "/tmp/.X11-unix/X" + std::to_string(number_);
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    std::ranges::copy(name, address.sun_path);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    return bind(fd_, reinterpret_cast<const sockaddr*>(&address), size) == 0;
  }

  int fd_;
  int number_ = 0;
};

}  // namespace fogline::test
