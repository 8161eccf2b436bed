#include "services/runtime/transport/udpm/fresh_url.h"

#include <netinet/in.h>
#include <sodium.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <deque>
#include <mutex>

#include <fmt/core.h>

namespace fogline::runtime {
namespace {

/// The ports of the last calls of FreshMulticastUrl(). The kernel delivers a multicast message to
/// every socket on the message's port, even if the socket has joined another group. So a run needs
/// a port that no other socket uses. The run's own sockets are often made later and in other
/// processes. So this process keeps the port for them.
class ReservedPorts {
 public:
  /// Reserves a UDP port of this machine. @return false if another socket has the port
  bool Add(std::uint16_t port) {
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket < 0) return true;  // the caller's own socket will report the error
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    // bind() fails with EADDRINUSE if another socket has the port. Any other error does not mean
    // that the port is taken.
    if (bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 &&
        errno == EADDRINUSE) {
      close(socket);
      return false;
    }
    // LCM's sockets can use the port, because they and this socket set SO_REUSEADDR. This socket
    // has joined no group and clears IP_MULTICAST_ALL, so it receives no messages.
    constexpr int kYes = 1, kNo = 0;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &kYes, sizeof(kYes));
    setsockopt(socket, IPPROTO_IP, IP_MULTICAST_ALL, &kNo, sizeof(kNo));
    const std::lock_guard lock(mutex_);
    sockets_.push_back(socket);
    if (sockets_.size() > kReservedPorts) {
      close(sockets_.front());
      sockets_.pop_front();
    }
    return true;
  }

 private:
  std::mutex mutex_;
  std::deque<int> sockets_;
};

}  // namespace

std::string FreshMulticastUrl() {
  // The ports lie above LCM's own port 7667 and below 32768. Linux gives the ports from 32768 on to
  // sockets that ask for no particular port (ip(7)). The group is LCM's own.
  constexpr std::uint32_t kFirstPort = 20000;
  constexpr std::uint32_t kPorts = 12000;
  constexpr int kTries = 20;  // if all tries find a taken port, the last port is used
  static ReservedPorts reserved;
  std::uint32_t port = 0;
  for (int i = 0; i < kTries; ++i) {
    port = kFirstPort + randombytes_uniform(kPorts);
    if (reserved.Add(static_cast<std::uint16_t>(port))) break;
  }
  return fmt::format("udpm://239.255.76.67:{}?ttl=0", port);
}

}  // namespace fogline::runtime
