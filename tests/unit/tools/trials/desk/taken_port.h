// A TCP port of this machine that other programs cannot have.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>

namespace fogline::test {

/// A port that this test occupies.
class TakenPort {
 public:
  explicit TakenPort(std::uint16_t port) : address_{} {
    address_.sin_family = AF_INET;
    address_.sin_port = htons(port);
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int yes = 1;  // old connections of this port may still be closing
    setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  }
  ~TakenPort() { close(socket_); }
  TakenPort(const TakenPort&) = delete;
  TakenPort& operator=(const TakenPort&) = delete;

  /// @return false while another program has the port
  bool Take() {
    bound_ = bound_ || bind(socket_, reinterpret_cast<sockaddr*>(&address_), sizeof(address_)) == 0;
    return bound_ && listen(socket_, 1) == 0;
  }
  /// The number of the port. If the constructor got 0, the system has chosen the number.
  std::uint16_t port() {
    socklen_t size = sizeof(address_);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address_), &size);
    return ntohs(address_.sin_port);
  }

 private:
  int socket_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address_;
  bool bound_ = false;
};

/// A port that no program uses at the time of the call.
inline std::uint16_t FreePort() {
  TakenPort port(0);
  return port.Take() ? port.port() : 0;
}

}  // namespace fogline::test
