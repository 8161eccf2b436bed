// The head of a UDP packet of LCM (source: LCM's udpm_util.h). A short message is one packet: the
// word "LC02", the number of the message, the channel's name with a final 0, and the data. A long
// message consists of several fragments. A fragment has the word "LC03", the number of the message,
// the size of the message's data, the offset of this part, the number of this fragment and the
// count of fragments. In the first fragment, the channel's name with a final 0 follows. All numbers
// are big endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "services/runtime/wire/wire.h"

namespace fogline::runtime {

struct LcmPacket {
  std::uint32_t number = 0;  // number of the message; each sender counts from 0
  bool is_fragment = false;  // whether the packet begins with "LC03"
  std::uint16_t fragment = 0;
  std::uint16_t fragments = 1;
  std::string_view channel;  // in the first packet of a message, otherwise ""
  std::size_t data_at = 0;   // where the packet's data begins
  std::uint32_t size = 0;    // size of the message's data; 0 if the packet is not a fragment
  std::uint32_t offset = 0;  // place of this part in the data; 0 if the packet is not a fragment

  bool First() const { return fragment == 0; }
  /// Whether this packet has a whole message, perhaps as its only fragment.
  bool Whole() const { return fragments == 1; }
};

/// The number of bytes of a packet that are enough for ParsePacket().
inline constexpr std::size_t kPacketHead = 20 + kLongestChannel + 1;

/// Reads the head of a packet.
/// @param head the packet, or its first kPacketHead bytes; LcmPacket::channel is a view of these
///     bytes
/// @return nullopt if LCM would not accept the packet
std::optional<LcmPacket> ParsePacket(Bytes head);

}  // namespace fogline::runtime
