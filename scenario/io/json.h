// JSON text as a tree that knows the place of each key and of each value in the text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenario/io/diagnostic_list.h"

namespace fogline {

struct JsonMember;
struct JsonValue;
using JsonArray = std::vector<JsonValue>;
using JsonObject = std::vector<JsonMember>;  // in the order of the text, duplicates included

/// A value and the place of its first byte. Null is std::monostate. A number without fraction and
/// exponent is an std::int64_t if it fits, otherwise a double.
struct JsonValue {
  std::variant<std::monostate, bool, std::int64_t, double, std::string, JsonArray, JsonObject> data;
  Place place;

  template <class T>
  const T* As() const {
    return std::get_if<T>(&data);
  }
  template <class T>
  T* As() {
    return std::get_if<T>(&data);
  }
};

struct JsonMember {
  std::string key;
  Place place;
  JsonValue value;
};

/// The first member with this key, or null.
const JsonMember* FindMember(const JsonObject& object, std::string_view key);
JsonMember* FindMember(JsonObject& object, std::string_view key);

/// Place of the value with this pointer. If the tree lacks this value, the result is the place of
/// its nearest parent in the tree.
Place FindPlace(const JsonValue& root, std::string_view pointer);

/// Description of the value for a message: `the text "abc"`, `the number 3`, `null`, `a list`.
std::string Describe(const JsonValue& value);

/// `base` and one more segment, which is escaped as RFC 6901 requires.
std::string JoinPointer(std::string_view base, std::string_view key);

/// Parses strict JSON (RFC 8259) in UTF-8: no comments, no NaN, no lone surrogates. Limits: 64 MiB
/// of text, 32 levels, two million values. Scenarios stay far below these limits. Because of the
/// limits a hostile text does not overflow the stack. After a mistake of syntax or size, the
/// function reports this mistake and returns nothing. The function also reports each duplicate key,
/// but still returns the tree.
/// @param base the JSON pointer of the root; the JSON pointers in `mistakes` begin with it
std::optional<JsonValue> ParseJson(std::string_view text, std::uint32_t source,
                                   DiagnosticList& mistakes, std::string_view base = "");

/// Largest size in bytes of a scenario file, and of a recorded leader's file.
inline constexpr std::size_t kMaxFileBytes = std::size_t{64} << 20U;

}  // namespace fogline
