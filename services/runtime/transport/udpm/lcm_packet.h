// The head of a UDP packet of LCM (LCM, udpm_util.h). A short message is one packet: the word
// "LC02", the number of the message, the channel with a 0, the data. A long message is several
// fragments: "LC03", the number, the size of the data, the offset of this part, the number of this
// fragment and the count of fragments; the first fragment then has the channel with a 0. All
// numbers are big endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "services/runtime/wire/wire.h"

namespace fogline::runtime {

struct LcmPacket {
  std::uint32_t number = 0;  // of the message; its sender counts its messages, beginning with 0
  bool is_fragment = false;  // whether it begins with "LC03"
  std::uint16_t fragment = 0;
  std::uint16_t fragments = 1;
  std::string_view channel;  // in the first packet of a message, otherwise ""
  std::size_t data_at = 0;   // where the packet's data begins
  std::uint32_t size = 0;    // of the message's data, in a fragment; otherwise 0
  std::uint32_t offset = 0;  // of this part of the data, in a fragment

  bool First() const { return fragment == 0; }
  /// Whether this packet has a whole message, perhaps as its only fragment.
  bool Whole() const { return fragments == 1; }
};

/// This many bytes of a packet are enough for ParsePacket().
inline constexpr std::size_t kPacketHead = 20 + kLongestChannel + 1;

/// @param head the packet, or its first kPacketHead bytes; the channel is valid as long as they are
/// @return nullopt if LCM would not take the packet
std::optional<LcmPacket> ParsePacket(Bytes head);

}  // namespace fogline::runtime
