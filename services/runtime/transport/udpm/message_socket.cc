#include "services/runtime/transport/udpm/message_socket.h"

#include <sys/socket.h>

#include <cerrno>
#include <stdexcept>

#include "common/process/poll.h"

namespace fogline::runtime {
namespace {

// The largest number of packets that Receive() reads until it finds a message. So a flood of other
// packets does not keep Wait() busy beyond its time limit. Other packets come only if the socket
// has no filter.
constexpr int kMostOthers = 100;

std::optional<MessageSocket::Message> MessageIn(Bytes packet) {
  const auto head = ParsePacket(packet);
  if (!head || head->is_fragment) return std::nullopt;
  const Bytes data = packet.subspan(head->data_at);
  if (data.size() > kMaxMessageBytes + kSignatureBytes) return std::nullopt;
  return MessageSocket::Message{.channel = head->channel, .data = data};
}

}  // namespace

MessageSocket::MessageSocket(const std::string& url, std::vector<sock_filter> filter)
    : socket_(url, std::move(filter)) {}

void MessageSocket::KeepBacklog() {
  backlog_.emplace(socket(), kMostPacket,
                   [](Bytes packet) { return MessageIn(packet).has_value(); });
}

bool MessageSocket::Wait(Duration timeout) {
  if (message_ || Receive()) return true;
  while (timeout > Duration::zero()) {
    const TimePoint began = Clock::now();
    const int ready = PollFor(fd(), POLLIN, timeout);
    if (ready < 0 && errno != EINTR) throw std::runtime_error("cannot wait for messages");
    if (ready <= 0) return false;
    if (Receive()) return true;
    timeout -= Clock::now() - began;
  }
  return false;
}

bool MessageSocket::Receive() {
  for (int i = 0; i < kMostOthers; ++i) {
    const auto packet = NextPacket();
    if (!packet) return false;
    message_ = MessageIn(*packet);
    if (message_) return true;
  }
  return false;
}

/// @return the next packet, or an empty packet if the packet is too large; nullopt if there is no
///     packet
std::optional<Bytes> MessageSocket::NextPacket() {
  if (backlog_) {
    auto packet = backlog_->Take();
    if (!packet) return std::nullopt;
    kept_ = std::move(*packet);
    return kept_;
  }
  // With MSG_TRUNC, recv() returns the size of the whole packet, even if the buffer is too small.
  const ssize_t size = recv(socket(), buffer_.data(), buffer_.size(), MSG_TRUNC);
  // There is no packet, or recv() has reported an error of the network. recv() reports such an
  // error only once, so the next call can succeed.
  if (size < 0) return std::nullopt;
  const auto bytes = static_cast<std::size_t>(size);
  return Bytes(buffer_.data(), bytes <= buffer_.size() ? bytes : 0);
}

}  // namespace fogline::runtime
