#include "tools/record/message_assembler.h"

#include <algorithm>

namespace fogline::record {
namespace {

// The largest message that LCM accepts, in bytes.
constexpr std::uint32_t kMostMessage = 1U << 28;

}  // namespace

std::optional<Message> MessageAssembler::Add(const watch::Packet& packet) {
  const auto head = runtime::ParsePacket(packet.bytes);
  if (!head) return std::nullopt;
  if (head->is_fragment) return AddFragment(packet, *head);
  return Message{.channel = head->channel,
                 .unix_us = packet.unix_us,
                 .data = packet.bytes.subspan(head->data_at)};
}

std::optional<Message> MessageAssembler::AddFragment(const watch::Packet& packet,
                                                     const runtime::LcmPacket& head) {
  const runtime::Bytes data = packet.bytes.subspan(head.data_at);
  const std::size_t end = head.offset + data.size();
  const bool is_possible =
      head.size <= kMostMessage && end <= head.size && head.size <= head.fragments * kMostPacket;
  if (!is_possible) return std::nullopt;
  const Key key{packet.from, head.number};
  const auto [at, is_new] = partial_.try_emplace(key);
  Partial& message = at->second;
  if (is_new) {
    message.size = head.size;
    message.arrived.resize(head.fragments);
    message.missing = head.fragments;
    message.order = packets_;
  }
  ++packets_;
  const bool agrees = message.size == head.size && message.arrived.size() == head.fragments;
  if (!agrees || message.arrived[head.fragment]) return std::nullopt;
  message.arrived[head.fragment] = true;
  --message.missing;
  if (head.First()) message.channel = head.channel;
  if (message.data.size() < end) {
    bytes_ += end - message.data.size();
    message.data.resize(end);
  }
  std::ranges::copy(data, message.data.begin() + static_cast<std::ptrdiff_t>(head.offset));
  if (message.missing > 0) {
    MakeRoom(key);
    return std::nullopt;
  }
  bytes_ -= message.data.size();
  whole_ = std::move(message);
  partial_.erase(at);
  if (whole_.data.size() != whole_.size) {
    ++given_up_;
    return std::nullopt;
  }
  return Message{.channel = whole_.channel, .unix_us = packet.unix_us, .data = whole_.data};
}

void MessageAssembler::MakeRoom(const Key& keep) {
  while (partial_.size() > 1 && (partial_.size() > kMostPartial || bytes_ > kMostBytes)) {
    auto oldest = partial_.end();
    for (auto at = partial_.begin(); at != partial_.end(); ++at) {
      if (at->first == keep) continue;
      if (oldest == partial_.end() || at->second.order < oldest->second.order) oldest = at;
    }
    bytes_ -= oldest->second.data.size();
    partial_.erase(oldest);
    ++given_up_;
  }
}

}  // namespace fogline::record
