#include "tools/watch/senders/packet_socket.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "services/runtime/transport/lcm_url.h"

namespace fogline::watch {
namespace {

// If no packet comes for this time, the socket renews its membership of the multicast group, as a
// bus does.
constexpr Duration kJoinAgainEvery = milliseconds(1000);

/// @throws std::runtime_error with the reason why the socket cannot be opened
[[noreturn]] void Fail(const std::string& url, const std::error_code& why) {
  throw std::runtime_error(
      fmt::format("the packets of {} cannot be counted: {}", url, why.message()));
}

/// @throws std::runtime_error if the socket cannot be opened
std::unique_ptr<runtime::GroupSocket> OpenSocket(const std::string& url, int buffer_bytes) {
  try {
    auto socket =
        std::make_unique<runtime::GroupSocket>(url, std::vector<sock_filter>(), buffer_bytes);
    const int on = 1;
    for (const int option : {SO_RXQ_OVFL, SO_TIMESTAMPNS}) {
      if (setsockopt(socket->fd(), SOL_SOCKET, option, &on, sizeof(on)) == 0) continue;
      Fail(url, std::error_code(errno, std::generic_category()));
    }
    return socket;
  } catch (const std::system_error& error) {
    Fail(url, error.code());
  }
}

}  // namespace

/// Buffers for recvmmsg().
struct PacketSocket::Batch {
  explicit Batch(std::size_t packet_bytes) : bytes(kBatch * packet_bytes) {
    for (std::size_t i = 0; i < kBatch; ++i) {
      parts[i] = {.iov_base = &bytes[i * packet_bytes], .iov_len = packet_bytes};
    }
  }
  /// Prepares the message headers for a call of recvmmsg(). Each call overwrites the lengths in
  /// these headers.
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
    : socket_(OpenSocket(url, options.buffer_bytes)),
      batch_(std::make_unique<Batch>(options.packet_bytes)),
      heard_(Clock::now()) {
  if (runtime::ReachOf(url) == runtime::LcmSockets::Reach::kRoute) {
    membership_.emplace(fd(), url);
  }
}

PacketSocket::~PacketSocket() = default;

void PacketSocket::Attend(bool heard, TimePoint now) {
  if (!heard && !(membership_ && now - heard_ >= kJoinAgainEvery)) return;
  heard_ = now;
  if (!heard) membership_->Renew();
}

int PacketSocket::Receive(const std::function<void(const Packet&)>& use) {
  // On an error, such as an interrupt, no packet counts as received: the next call tries again.
  const int count = recvmmsg(fd(), batch_->Ready(), kBatch, 0, nullptr);
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
