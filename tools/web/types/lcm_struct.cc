#include "tools/web/types/lcm_struct.h"

#include <algorithm>

namespace fogline::web {
namespace {

struct PrimitiveInfo {
  std::string_view name;
  LcmPrimitive primitive;
  std::size_t size;
};

/// The primitive types in the order of LcmPrimitive.
constexpr std::array kPrimitives{
    PrimitiveInfo{"int8_t", LcmPrimitive::kInt8, 1},
    PrimitiveInfo{"int16_t", LcmPrimitive::kInt16, 2},
    PrimitiveInfo{"int32_t", LcmPrimitive::kInt32, 4},
    PrimitiveInfo{"int64_t", LcmPrimitive::kInt64, 8},
    PrimitiveInfo{"byte", LcmPrimitive::kByte, 1},
    PrimitiveInfo{"boolean", LcmPrimitive::kBoolean, 1},
    PrimitiveInfo{"float", LcmPrimitive::kFloat, 4},
    PrimitiveInfo{"double", LcmPrimitive::kDouble, 8},
    PrimitiveInfo{"string", LcmPrimitive::kString, 0},
};

constexpr std::array kUnits = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"_m", "m"},
    {"_mps", "m/s"},
    {"_mps2", "m/s²"},
    {"_s", "s"},
    {"_ms", "ms"},
    {"_us", "µs"},
    {"_hz", "Hz"},
});

// Adds a byte to a hash in the same way as lcm-gen. lcm-gen computes with int64_t, so its right
// shift keeps the sign. It adds characters as signed numbers.
std::int64_t HashByte(std::int64_t hash, std::int64_t byte) {
  const std::uint64_t mixed =
      (static_cast<std::uint64_t>(hash) << 8) ^ static_cast<std::uint64_t>(hash >> 55);
  return static_cast<std::int64_t>(mixed + static_cast<std::uint64_t>(byte));
}

std::int64_t HashText(std::int64_t hash, std::string_view text) {
  hash = HashByte(hash, static_cast<std::int8_t>(text.size()));
  for (const char c : text) hash = HashByte(hash, static_cast<std::int8_t>(c));
  return hash;
}

}  // namespace

std::optional<LcmPrimitive> PrimitiveNamed(std::string_view name) {
  const auto info = std::ranges::find(kPrimitives, name, &PrimitiveInfo::name);
  return info == kPrimitives.end() ? std::nullopt : std::optional(info->primitive);
}

std::size_t WireSize(LcmPrimitive primitive) {
  return kPrimitives[static_cast<std::size_t>(primitive)].size;
}

bool MayBeLength(LcmPrimitive primitive) {
  return primitive == LcmPrimitive::kInt8 || primitive == LcmPrimitive::kInt16 ||
         primitive == LcmPrimitive::kInt32 || primitive == LcmPrimitive::kInt64;
}

std::int64_t OwnHash(const LcmStruct& type) {
  constexpr std::int64_t kBegin = 0x12345678;
  constexpr std::int64_t kFixed = 0;   // lcm-gen's LCM_CONST
  constexpr std::int64_t kVaries = 1;  // lcm-gen's LCM_VAR
  std::int64_t hash = kBegin;
  for (const LcmMember& member : type.members) {
    hash = HashText(hash, member.name);
    if (member.primitive) hash = HashText(hash, member.type);
    hash = HashByte(hash, static_cast<std::int64_t>(member.dimensions.size()));
    for (const LcmDimension& dimension : member.dimensions) {
      hash = HashByte(hash, dimension.fixed ? kFixed : kVaries);
      hash = HashText(hash, dimension.size);
    }
  }
  return hash;
}

std::string_view UnitOf(std::string_view field) {
  for (const auto& [suffix, unit] : kUnits) {
    if (field.ends_with(suffix)) return unit;
  }
  return "";
}

}  // namespace fogline::web
