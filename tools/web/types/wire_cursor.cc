#include "tools/web/types/wire_cursor.h"

#include <bit>

namespace fogline::web {

std::optional<std::uint64_t> WireCursor::Take(std::size_t bytes) {
  if (bytes > rest_.size()) return std::nullopt;
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | rest_[i];
  rest_ = rest_.subspan(bytes);
  return value;
}

std::optional<std::int64_t> WireCursor::Integer(LcmPrimitive primitive) {
  const auto bits = Take(WireSize(primitive));
  if (!bits) return std::nullopt;
  switch (primitive) {
    case LcmPrimitive::kInt16:
      return static_cast<std::int16_t>(*bits);
    case LcmPrimitive::kInt32:
      return static_cast<std::int32_t>(*bits);
    case LcmPrimitive::kInt64:
      return static_cast<std::int64_t>(*bits);
    case LcmPrimitive::kByte:
      return static_cast<std::int64_t>(*bits);
    default:  // int8_t and boolean
      return static_cast<std::int8_t>(*bits);
  }
}

std::optional<double> WireCursor::Number(LcmPrimitive primitive) {
  if (primitive == LcmPrimitive::kFloat) {
    const auto bits = Take(sizeof(float));
    return bits ? std::optional<double>(std::bit_cast<float>(static_cast<std::uint32_t>(*bits)))
                : std::nullopt;
  }
  if (primitive == LcmPrimitive::kDouble) {
    const auto bits = Take(sizeof(double));
    return bits ? std::optional(std::bit_cast<double>(*bits)) : std::nullopt;
  }
  const auto value = Integer(primitive);
  return value ? std::optional(static_cast<double>(*value)) : std::nullopt;
}

std::optional<std::string_view> WireCursor::Text() {
  const auto length = Integer(LcmPrimitive::kInt32);  // including the 0 at the end
  if (!length || *length < 1 || static_cast<std::uint64_t>(*length) > rest_.size()) {
    return std::nullopt;
  }
  const auto size = static_cast<std::size_t>(*length) - 1;
  const std::string_view text(reinterpret_cast<const char*>(rest_.data()), size + 1);
  if (text.find('\0') != size) return std::nullopt;
  rest_ = rest_.subspan(size + 1);
  return text.substr(0, size);
}

std::optional<Extent> WireCursor::ExtentOf(const LcmMember& member, const Lengths& lengths) const {
  Extent extent;
  const std::size_t dimensions = member.dimensions.size();
  for (std::size_t i = 0; i < dimensions; ++i) {
    const LcmDimension& dimension = member.dimensions[i];
    if (dimension.fixed) {
      extent.sizes[i] = *dimension.fixed;
    } else {
      const std::int64_t length = lengths[dimension.slot];
      if (length < 0) return std::nullopt;
      extent.sizes[i] = static_cast<std::size_t>(length);
    }
    if (extent.sizes[i] == 0) extent.count = 0;
  }
  for (std::size_t i = 0; i < dimensions && extent.count > 0; ++i) {
    if (extent.sizes[i] > rest_.size() / extent.count) return std::nullopt;
    extent.count *= extent.sizes[i];
  }
  return extent;
}

bool WireCursor::SkipMember(const LcmTypes& types, const LcmMember& member, Lengths& lengths) {
  if (member.length_slot) {
    const auto length = Integer(*member.primitive);
    if (length) lengths[*member.length_slot] = *length;
    return length.has_value();
  }
  const auto extent = ExtentOf(member, lengths);
  return extent && SkipElements(types, member, extent->count);
}

bool WireCursor::SkipElements(const LcmTypes& types, const LcmMember& member, std::size_t count) {
  if (member.primitive && *member.primitive != LcmPrimitive::kString) {
    return Skip(count * WireSize(*member.primitive));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const bool whole =
        member.primitive ? Text().has_value() : SkipStruct(types, types.StructOf(member));
    if (!whole) return false;
  }
  return true;
}

bool WireCursor::SkipStruct(const LcmTypes& types, const LcmStruct& type) {
  if (type.fixed_size) return Skip(*type.fixed_size);
  Lengths lengths{};
  for (const LcmMember& member : type.members) {
    if (!SkipMember(types, member, lengths)) return false;
  }
  return true;
}

}  // namespace fogline::web
