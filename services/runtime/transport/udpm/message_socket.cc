#include "services/runtime/transport/udpm/message_socket.h"

#include <sys/socket.h>

#include <cerrno>
#include <stdexcept>
#include <utility>

#include "common/process/poll.h"
#include "services/runtime/transport/kernel_limits.h"

namespace fogline::runtime {
namespace {

// Wait() looks at no more than this many packets that are no messages, so that a flood of them does
// not keep the caller from other work. Only without a filter such packets come.
constexpr int kMostOthers = 100;

}  // namespace

MessageSocket::MessageSocket(const std::string& url, std::vector<sock_filter> filter)
    : socket_(url, kWideBuffer, std::move(filter)) {}

bool MessageSocket::Wait(Duration timeout) {
  if (message_ || Receive()) return true;
  if (timeout <= Duration::zero()) return false;
  const int ready = PollFor(fd(), POLLIN, timeout);
  if (ready < 0 && errno != EINTR) throw std::runtime_error("cannot wait for messages");
  return ready > 0 && Receive();
}

bool MessageSocket::Receive() {
  for (int i = 0; i < kMostOthers; ++i) {
    // MSG_TRUNC: the size is that of the whole packet, even if the packet is too large.
    const ssize_t size = recv(fd(), packet_.data(), packet_.size(), MSG_TRUNC);
    if (size < 0) return false;  // nothing is there, or an interrupt or an error of the network
    const auto bytes = static_cast<std::size_t>(size);
    if (bytes > packet_.size()) continue;
    const Bytes packet(packet_.data(), bytes);
    const auto head = ParsePacket(packet);
    if (!head || !head->Whole() || head->size > 0) continue;
    const Bytes data = packet.subspan(head->data_at);
    if (data.size() > kMaxMessageBytes + kSignatureBytes) continue;
    message_ = Message{.channel = head->channel, .data = data};
    return true;
  }
  return false;
}

}  // namespace fogline::runtime
