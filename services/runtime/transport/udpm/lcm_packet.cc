#include "services/runtime/transport/udpm/lcm_packet.h"

namespace fogline::runtime {
namespace {

constexpr std::size_t kShortHead = 8;
constexpr std::size_t kFragmentHead = 20;
constexpr std::size_t kSizeOffset = 8;
constexpr std::size_t kPartOffset = 12;
constexpr std::size_t kFragmentOffset = 16;
constexpr std::size_t kFragmentsOffset = 18;

/// A big-endian number of `size` bytes. The caller has checked that the bytes are there.
std::uint32_t Number(Bytes bytes, std::size_t offset, std::size_t size) {
  std::uint32_t value = 0;
  for (const std::uint8_t byte : bytes.subspan(offset, size)) value = value << 8 | byte;
  return value;
}

/// The channel's name at the beginning of these bytes; nullopt if its final 0 is missing, or if the
/// name is too long for LCM.
std::optional<std::string_view> ChannelAt(Bytes bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t length = text.substr(0, kLongestChannel + 1).find('\0');
  if (length == std::string_view::npos) return std::nullopt;
  return text.substr(0, length);
}

}  // namespace

std::optional<LcmPacket> ParsePacket(Bytes head) {
  if (head.size() < kShortHead) return std::nullopt;
  LcmPacket packet{.number = Number(head, 4, 4), .channel = ""};
  const std::uint32_t kind = Number(head, 0, 4);
  std::size_t end = kShortHead;
  if (kind == kLcmFragment) {
    packet.is_fragment = true;
    end = kFragmentHead;
    if (head.size() < end) return std::nullopt;
    packet.size = Number(head, kSizeOffset, 4);
    packet.offset = Number(head, kPartOffset, 4);
    packet.fragment = static_cast<std::uint16_t>(Number(head, kFragmentOffset, 2));
    packet.fragments = static_cast<std::uint16_t>(Number(head, kFragmentsOffset, 2));
    if (packet.fragment >= packet.fragments) return std::nullopt;
  } else if (kind != kLcmMessage) {
    return std::nullopt;
  }
  packet.data_at = end;
  if (!packet.First()) return packet;
  const auto channel = ChannelAt(head.subspan(end));
  if (!channel) return std::nullopt;
  packet.channel = *channel;
  packet.data_at += channel->size() + 1;
  return packet;
}

}  // namespace fogline::runtime
