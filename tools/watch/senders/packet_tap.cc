#include "tools/watch/senders/packet_tap.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "services/runtime/transport/lcm_url.h"

namespace fogline::watch {
namespace {

constexpr std::size_t kBatch = 64;  // packets in one system call
// Without packets for this long the tap renews its membership of the group, as a bus does.
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

/// Asks for a large buffer. Without CAP_NET_ADMIN the kernel grants at most net.core.rmem_max.
void WidenBuffer(int fd) {
  constexpr int kBytes = 8 * 1024 * 1024;
  if (setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &kBytes, sizeof(kBytes)) == 0) return;
  setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &kBytes, sizeof(kBytes));
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

}  // namespace

/// Buffers for recvmmsg().
struct PacketTap::Batch {
  Batch() {
    for (std::size_t i = 0; i < kBatch; ++i) {
      parts[i] = {.iov_base = heads[i].data(), .iov_len = heads[i].size()};
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
    alignas(cmsghdr) char bytes[CMSG_SPACE(sizeof(std::uint32_t))];
  };
  std::array<std::array<std::uint8_t, kPacketHead>, kBatch> heads;
  std::array<iovec, kBatch> parts;
  std::array<sockaddr_in, kBatch> senders;
  std::array<Control, kBatch> controls;
  std::array<mmsghdr, kBatch> messages;
};

std::unique_ptr<PacketTap> PacketTap::Open(const std::string& url, Senders& senders) {
  const auto network = runtime::ParseMulticastUrl(url);
  if (!network) return nullptr;
  Socket socket;
  if (socket.fd() < 0) Fail(url, errno);
  Set(socket.fd(), SOL_SOCKET, SO_REUSEADDR, 1, url);
  Set(socket.fd(), SOL_SOCKET, SO_REUSEPORT, 1, url);
  Set(socket.fd(), SOL_SOCKET, SO_RXQ_OVFL, 1, url);
  WidenBuffer(socket.fd());
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(network->port);
  inet_pton(AF_INET, network->group.c_str(), &address.sin_addr);
  // Bound to the group, the socket gets no packets of other groups on the same port.
  if (bind(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    Fail(url, errno);
  }
  Join(socket.fd(), address.sin_addr, url);
  return std::unique_ptr<PacketTap>(new PacketTap(socket.Release(), url, senders));
}

PacketTap::PacketTap(int fd, const std::string& url, Senders& senders)
    : fd_(fd), senders_(senders), batch_(std::make_unique<Batch>()), heard_(Clock::now()) {
  if (runtime::ReachOf(url) == runtime::LcmSockets::Reach::kRoute) {
    membership_.emplace(std::vector<int>{fd}, url);
  }
}

PacketTap::~PacketTap() { close(fd_); }

void PacketTap::Drain(TimePoint now) {
  int taken = 0;
  while (taken < kDrained) {
    const int count = Receive(now);
    taken += count;
    if (count < static_cast<int>(kBatch)) break;
  }
  if (taken > 0) {
    heard_ = now;
  } else if (membership_ && now - heard_ >= kJoinAgainEvery) {
    heard_ = now;
    membership_->Renew();
  }
}

/// @return the number of packets received
int PacketTap::Receive(TimePoint now) {
  // An error, such as an interrupt, means that nothing is there yet: the next call tries again.
  const int count = recvmmsg(fd_, batch_->Ready(), kBatch, 0, nullptr);
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    mmsghdr& message = batch_->messages[at];
    std::uint32_t dropped = dropped_;
    for (cmsghdr* control = CMSG_FIRSTHDR(&message.msg_hdr); control != nullptr;
         control = CMSG_NXTHDR(&message.msg_hdr, control)) {
      if (control->cmsg_level != SOL_SOCKET || control->cmsg_type != SO_RXQ_OVFL) continue;
      std::memcpy(&dropped, CMSG_DATA(control), sizeof(dropped));
    }
    senders_.AddDropped(dropped - std::exchange(dropped_, dropped));
    const sockaddr_in& from = batch_->senders[at];
    senders_.Add({.host = ntohl(from.sin_addr.s_addr), .port = ntohs(from.sin_port)},
                 runtime::Bytes(batch_->heads[at]).first(message.msg_len), now);
  }
  return count > 0 ? count : 0;
}

}  // namespace fogline::watch
