// The wire format of Protocol Buffers (protobuf.dev/programming-guides/encoding), as far as
// messages of lcmtypes/ need it. A record consists of a tag and a value. The tag has the number of
// the field and the kind of the value.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "tools/web/types/little_endian.h"

namespace fogline::mcap {

/// How a value is written.
enum class WireKind : std::uint8_t {
  kVarint = 0,   // integers and booleans
  kFixed64 = 1,  // double
  kLength = 2,   // strings, bytes, messages, packed numbers: the length, then the bytes
  kFixed32 = 5,  // float
};

/// Appends a number in groups of seven bits, the lowest group first. Each group is one byte. The
/// highest bit is set in each byte except the last. A negative number has ten bytes, as in
/// protobuf's int32 and int64.
inline void PutVarint(std::uint64_t value, std::string& to) {
  constexpr std::uint64_t kMore = 0x80;
  for (; value >= kMore; value >>= 7) to += static_cast<char>(value | kMore);
  to += static_cast<char>(value);
}

inline void PutTag(std::uint32_t number, WireKind kind, std::string& to) {
  PutVarint(std::uint64_t{number} << 3 | static_cast<std::uint64_t>(kind), to);
}

inline void PutIntegerField(std::uint32_t number, std::int64_t value, std::string& to) {
  PutTag(number, WireKind::kVarint, to);
  PutVarint(static_cast<std::uint64_t>(value), to);
}

/// Appends a field with a length: a string, the bytes of a message, or packed numbers.
inline void PutLengthField(std::uint32_t number, std::string_view bytes, std::string& to) {
  PutTag(number, WireKind::kLength, to);
  PutVarint(bytes.size(), to);
  to += bytes;
}

}  // namespace fogline::mcap
