#include "tools/web/message_ring.h"

#include <algorithm>
#include <cstring>

#include "tools/web/types/little_endian.h"

namespace fogline::web {
namespace {

constexpr std::size_t kRingHeader = sizeof(std::uint16_t) + sizeof(double) + sizeof(std::uint32_t);

}  // namespace

void MessageRing::Add(const RingMessage& message) {
  const std::size_t size = kRingHeader + message.bytes.size();
  if (chunks_.empty() || chunks_.back().bytes.size() + size > kChunkBytes) {
    Trim(message.wall_ms, std::max(size, kChunkBytes));
    chunks_.push_back({.begin = end_, .newest_ms = 0, .bytes = {}});
    chunks_.back().bytes.reserve(std::max(size, kChunkBytes));
  }
  Chunk& chunk = chunks_.back();
  AddRingMessage(message, chunk.bytes);
  chunk.newest_ms = message.wall_ms;
  end_ += size;
}

void MessageRing::Trim(double now_ms, std::size_t room) {
  const auto is_old = [&](const Chunk& chunk) {
    return end_ - chunk.begin + room > kMostBytes || now_ms - chunk.newest_ms > kMost_ms;
  };
  while (!chunks_.empty() && is_old(chunks_.front())) chunks_.pop_front();
}

std::string_view MessageRing::From(std::uint64_t place) const {
  if (place >= end_) return "";
  const auto behind = std::ranges::upper_bound(chunks_, place, {}, &Chunk::begin);
  const Chunk& chunk = *std::prev(behind);
  return std::string_view(chunk.bytes).substr(static_cast<std::size_t>(place - chunk.begin));
}

void AddRingMessage(const RingMessage& message, std::string& messages) {
  PutLittleEndian(message.channel, messages);
  PutLittleEndian(message.wall_ms, messages);
  PutLittleEndian(static_cast<std::uint32_t>(message.bytes.size()), messages);
  messages.append(reinterpret_cast<const char*>(message.bytes.data()), message.bytes.size());
}

RingMessage TakeRingMessage(std::string_view& messages) {
  RingMessage message;
  message.channel = TakeLittleEndian<std::uint16_t>(messages);
  message.wall_ms = TakeLittleEndian<double>(messages);
  const auto size = TakeLittleEndian<std::uint32_t>(messages);
  message.bytes = {reinterpret_cast<const std::uint8_t*>(messages.data()), size};
  messages.remove_prefix(size);
  return message;
}

}  // namespace fogline::web
