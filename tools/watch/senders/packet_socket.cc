#include "tools/watch/senders/packet_socket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "services/runtime/transport/lcm_url.h"

namespace fogline::watch {
namespace {

// Without packets for this long the socket renews its membership of the group, as a bus does.
constexpr Duration kJoinAgainEvery = milliseconds(1000);

/// A descriptor that is closed unless it is released.
class Socket {
 public:
  Socket() : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {}
  ~Socket() {
    if (fd_ >= 0) close(fd_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  int fd() const { return fd_; }
  int Release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

[[noreturn]] void Fail(const std::string& url, int error) {
  throw std::runtime_error(
      fmt::format("the packets of {} cannot be counted: {}", url, std::strerror(error)));
}

void Set(int fd, int level, int option, int value, const std::string& url) {
  if (setsockopt(fd, level, option, &value, sizeof(value)) != 0) Fail(url, errno);
}

/// Asks for a buffer. Without CAP_NET_ADMIN the kernel grants at most net.core.rmem_max.
void WidenBuffer(int fd, int bytes) {
  if (setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof(bytes)) == 0) return;
  setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
}

/// Joins the group where LCM's sockets join it: on the route, and on loopback if the traffic stays
/// on this machine (lcm_sockets.h).
void Join(int fd, const in_addr& group, const std::string& url) {
  ip_mreq membership{.imr_multiaddr = group, .imr_interface = {}};
  bool joined = setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) == 0;
  if (runtime::ReachOf(url) == runtime::LcmSockets::Reach::kLoopback) {
    membership.imr_interface.s_addr = htonl(INADDR_LOOPBACK);
    // If the route leads over loopback, the socket is already in the group there.
    joined = setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) == 0 ||
             errno == EADDRINUSE;
  }
  if (!joined) Fail(url, errno);
}

/// @return a socket in the group of the URL
int OpenSocket(const std::string& url, int buffer_bytes) {
  const auto network = runtime::ParseMulticastUrl(url);
  Socket socket;
  if (!network || socket.fd() < 0) Fail(url, network ? errno : EINVAL);
  Set(socket.fd(), SOL_SOCKET, SO_REUSEADDR, 1, url);
  Set(socket.fd(), SOL_SOCKET, SO_REUSEPORT, 1, url);
  Set(socket.fd(), SOL_SOCKET, SO_RXQ_OVFL, 1, url);
  Set(socket.fd(), SOL_SOCKET, SO_TIMESTAMPNS, 1, url);
  WidenBuffer(socket.fd(), buffer_bytes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(network->port);
  inet_pton(AF_INET, network->group.c_str(), &address.sin_addr);
  // Bound to the group, the socket gets no packets of other groups on the same port.
  if (bind(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    Fail(url, errno);
  }
  Join(socket.fd(), address.sin_addr, url);
  return socket.Release();
}

}  // namespace

/// Buffers for recvmmsg().
struct PacketSocket::Batch {
  explicit Batch(std::size_t packet_bytes) : bytes(kBatch * packet_bytes) {
    for (std::size_t i = 0; i < kBatch; ++i) {
      parts[i] = {.iov_base = &bytes[i * packet_bytes], .iov_len = packet_bytes};
    }
  }
  /// Makes the messages ready for the next call, which overwrites their lengths.
  mmsghdr* Ready() {
    for (std::size_t i = 0; i < kBatch; ++i) {
      msghdr& header = messages[i].msg_hdr;
      header = {};
      header.msg_name = &senders[i];
      header.msg_namelen = sizeof(senders[i]);
      header.msg_iov = &parts[i];
      header.msg_iovlen = 1;
      header.msg_control = controls[i].bytes;
      header.msg_controllen = sizeof(controls[i].bytes);
    }
    return messages.data();
  }

  struct Control {
    alignas(cmsghdr) char bytes[CMSG_SPACE(sizeof(std::uint32_t)) + CMSG_SPACE(sizeof(timespec))];
  };
  std::vector<std::uint8_t> bytes;
  std::array<iovec, kBatch> parts;
  std::array<sockaddr_in, kBatch> senders;
  std::array<Control, kBatch> controls;
  std::array<mmsghdr, kBatch> messages;
};

PacketSocket::PacketSocket(const std::string& url, const Options& options)
    : fd_(OpenSocket(url, options.buffer_bytes)),
      batch_(std::make_unique<Batch>(options.packet_bytes)),
      heard_(Clock::now()) {
  if (runtime::ReachOf(url) == runtime::LcmSockets::Reach::kRoute) {
    membership_.emplace(std::vector<int>{fd_}, url);
  }
}

PacketSocket::~PacketSocket() { close(fd_); }

int PacketSocket::buffer_bytes() const {
  int bytes = 0;
  socklen_t size = sizeof(bytes);
  getsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &bytes, &size);
  return bytes / 2;  // the kernel doubles the size that was asked for (socket(7))
}

void PacketSocket::Attend(bool heard, TimePoint now) {
  if (!heard && !(membership_ && now - heard_ >= kJoinAgainEvery)) return;
  heard_ = now;
  if (!heard) membership_->Renew();
}

int PacketSocket::Receive(const std::function<void(const Packet&)>& use) {
  // An error, such as an interrupt, means that nothing is there yet: the next call tries again.
  const int count = recvmmsg(fd_, batch_->Ready(), kBatch, 0, nullptr);
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    mmsghdr& message = batch_->messages[at];
    std::uint32_t dropped = dropped_;
    timespec time{};
    for (cmsghdr* control = CMSG_FIRSTHDR(&message.msg_hdr); control != nullptr;
         control = CMSG_NXTHDR(&message.msg_hdr, control)) {
      if (control->cmsg_level != SOL_SOCKET) continue;
      if (control->cmsg_type == SO_RXQ_OVFL) {
        std::memcpy(&dropped, CMSG_DATA(control), sizeof(dropped));
      } else if (control->cmsg_type == SCM_TIMESTAMPNS) {
        std::memcpy(&time, CMSG_DATA(control), sizeof(time));
      }
    }
    const sockaddr_in& from = batch_->senders[at];
    const auto* first = static_cast<const std::uint8_t*>(batch_->parts[at].iov_base);
    use({.from = {.host = ntohl(from.sin_addr.s_addr), .port = ntohs(from.sin_port)},
         .bytes = {first, message.msg_len},
         .dropped = dropped - std::exchange(dropped_, dropped),
         .unix_us = std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000});
  }
  return count > 0 ? count : 0;
}

}  // namespace fogline::watch
