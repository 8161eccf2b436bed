// Reads the bytes of an LCM message from front to back, by the description of its type. The cursor
// never reads beyond the end, and refuses a length for which the message has no room.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "tools/web/types/lcm_types.h"

namespace fogline::web {

/// The largest possible size of an LCM message, in bytes. In a message in fragments, the size is a
/// number of 32 bits (LCM, udpm_util.h).
inline constexpr std::size_t kLargestMessage = 0xffff'ffff;

/// The values of a struct's members that are lengths, by LcmMember::length_slot.
using Lengths = std::array<std::int64_t, kMaxLengths>;

/// The dimensions of a member in one message.
struct Extent {
  std::array<std::size_t, kMaxDimensions> sizes{};
  std::size_t count = 1;  // number of elements; 0 if any dimension is 0
};

/// A position in a message. Each function reads a value, and moves to the position after it. If the
/// message does not contain the value, the function returns nullopt or false, and the cursor must
/// not be used further.
class WireCursor {
 public:
  explicit WireCursor(Bytes message) : rest_(message) {}

  bool Skip(std::size_t bytes) {
    if (bytes > rest_.size()) return false;
    rest_ = rest_.subspan(bytes);
    return true;
  }
  bool AtEnd() const { return rest_.empty(); }

  /// @pre the primitive is an integer, a byte or a boolean
  std::optional<std::int64_t> Integer(LcmPrimitive primitive);
  /// Any number, or a byte or a boolean as a number. @pre the primitive is not a string
  std::optional<double> Number(LcmPrimitive primitive);
  /// A string with a 0 at its end and no other 0. The view is valid as long as the message.
  std::optional<std::string_view> Text();

  /// The dimensions of a member; nullopt if the message has no room for the elements. Every element
  /// takes at least one byte, so there are at most as many elements as remaining bytes.
  std::optional<Extent> ExtentOf(const LcmMember& member, const Lengths& lengths) const;

  /// Skips a member with all its elements; keeps its value if it is a length.
  bool SkipMember(const LcmTypes& types, const LcmMember& member, Lengths& lengths);
  /// Skips `count` elements of a member.
  bool SkipElements(const LcmTypes& types, const LcmMember& member, std::size_t count);

 private:
  bool SkipStruct(const LcmTypes& types, const LcmStruct& type);
  std::optional<std::uint64_t> Take(std::size_t bytes);

  Bytes rest_;
};

}  // namespace fogline::web
