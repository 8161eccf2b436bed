// Messages as bytes: encoding, checked decoding, and the parts of the header that every message
// has.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "fogline/fields.hpp"
#include "fogline/fingerprint.hpp"
#include "services/graph.h"

namespace fogline::runtime {

using Bytes = std::span<const std::uint8_t>;

/// The largest message. With the headers of UDP and LCM, the channel's name and a signature, a
/// message of this size fits into one Ethernet frame. So the message is not fragmented.
inline constexpr std::size_t kMaxMessageBytes = 1400;
/// LCM's longest channel name (LCM_MAX_CHANNEL_NAME_LENGTH), in bytes.
inline constexpr std::size_t kLongestChannel = 63;

/// The first word of a UDP packet of LCM, big endian: a whole message ("LC02"), or a fragment of a
/// message ("LC03").
inline constexpr std::uint32_t kLcmMessage = 0x4c433032;
inline constexpr std::uint32_t kLcmFragment = 0x4c433033;

/// Every message begins with its type's fingerprint (8 bytes) and header_t: run_id, step, utime.
inline constexpr std::size_t kRunIdOffset = 8;
inline constexpr std::size_t kStepOffset = 16;
inline constexpr std::size_t kHeaderEnd = 32;

/// Big-endian integer at an offset. The caller has checked the size.
inline std::int64_t ReadInt64(Bytes bytes, std::size_t offset) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  if constexpr (std::endian::native == std::endian::little) value = __builtin_bswap64(value);
  return static_cast<std::int64_t>(value);
}

/// A text as LCM encodes it: the length including the final 0, big endian, and then the characters
/// and the 0.
inline std::string EncodedText(std::string_view text) {
  const std::size_t size = text.size() + 1;
  std::string encoded;
  for (const int shift : {24, 16, 8, 0}) encoded += static_cast<char>((size >> shift) & 0xff);
  encoded += text;
  return encoded + '\0';
}

/// The fingerprint with which the messages of a channel begin.
/// @param channel index in kChannels
inline std::int64_t FingerprintOf(std::size_t channel) {
  static const auto fingerprints = std::apply(
      [](const auto&... each) {
        return std::array{std::decay_t<decltype(each)>::Message::getHash()...};
      },
      kGraph);
  return fingerprints[channel];
}

// LCM's generated code works byte by byte. If all of it is inlined (flatten), its offsets are
// constants, and the compiler makes one load and one byte swap for each number.

/// Encodes a message into `buffer`, which keeps its capacity.
template <class M>
[[gnu::flatten]] void Encode(const M& message, std::vector<std::uint8_t>& buffer) {
  buffer.resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(buffer.data(), 0, static_cast<int>(buffer.size()));
}

/// Decodes a whole message; false if the bytes are not exactly one message of this type. Never
/// throws: the generated decoders check every length before they use it (cmake/lcmtypes.cmake).
template <class M>
[[nodiscard, gnu::flatten]] bool Decode(Bytes bytes, M& message) {
  return bytes.size() >= kHeaderEnd &&
         message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) ==
             static_cast<int>(bytes.size());
}

/// Name of the first field with a value that is not finite; "" if there is none.
template <class M>
std::string_view FirstNonFiniteField(const M& message) {
  std::string_view found;
  VisitFields(message, [&found](std::string_view name, const auto& value) {
    using V = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<V, double>) {
      if (found.empty() && !std::isfinite(value)) found = name;
    } else if constexpr (std::is_same_v<V, std::span<const double>>) {
      for (const double element : value) {
        if (found.empty() && !std::isfinite(element)) found = name;
      }
    }
  });
  return found;
}

}  // namespace fogline::runtime
