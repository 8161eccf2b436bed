#include "tools/web/types/field_reader.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"
#include "tools/web/types/fields.h"
#include "tools/web/types/wire_cursor.h"

namespace fogline::web {
namespace {

const LcmMember& MemberNamed(const LcmStruct& type, std::string_view name) {
  const auto member = std::ranges::find(type.members, name, &LcmMember::name);
  if (member != type.members.end()) return *member;
  std::vector<std::string_view> names;
  for (const LcmMember& candidate : type.members) names.push_back(candidate.name);
  throw InputError(fmt::format("{} has no field {}{}", type.name, QuoteShort(name),
                               DidYouMean(Nearest(name, names))));
}

/// Checks the indices of a path against the member's dimensions.
void CheckIndices(const LcmMember& member, const PathPart& part) {
  if (part.indices.size() != member.dimensions.size()) {
    throw InputError(fmt::format("{} needs {} {}, not {}", member.name, member.dimensions.size(),
                                 member.dimensions.size() == 1 ? "index" : "indices",
                                 part.indices.size()));
  }
  for (std::size_t i = 0; i < part.indices.size(); ++i) {
    const auto& fixed = member.dimensions[i].fixed;
    if (!fixed || part.indices[i] < *fixed) continue;
    throw InputError(
        fmt::format("{}: index {} is not below {}", member.name, part.indices[i], *fixed));
  }
}

/// The index of an element among all elements of a member; nullopt if there is no such element.
std::optional<std::size_t> PlaceOf(const std::vector<std::size_t>& indices, const Extent& extent) {
  std::size_t place = 0;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] >= extent.sizes[i]) return std::nullopt;
    place = place * extent.sizes[i] + indices[i];
  }
  return place;
}

}  // namespace

FieldReader::FieldReader(const LcmTypes& types, const LcmStruct& type, std::string_view path)
    : types_(types), fingerprint_(type.fingerprint) {
  const LcmStruct* within = &type;
  for (const PathPart& part : ParsePath(path)) {
    if (within == nullptr) {
      throw InputError(
          fmt::format("{}: {} has no fields", QuoteShort(path), levels_.back().target->name));
    }
    const LcmMember& target = MemberNamed(*within, part.name);
    CheckIndices(target, part);
    Level& level = levels_.emplace_back();
    level.target = &target;
    level.indices = part.indices;
    Stride stride;
    for (const LcmMember& before : within->members) {
      if (&before == &target) break;
      const auto fixed = types.FixedSize(before);
      if (fixed && !before.length_slot) {
        stride.bytes += *fixed;
        continue;
      }
      stride.member = &before;
      level.strides.push_back(stride);
      stride = {};
    }
    level.strides.push_back(stride);
    within = target.primitive ? nullptr : &types.StructOf(target);
  }
  const LcmMember& last = *levels_.back().target;
  if (!last.primitive || *last.primitive == LcmPrimitive::kString) {
    throw InputError(fmt::format("{} is no number but a {}", QuoteShort(path),
                                 last.primitive ? "text" : "struct"));
  }
}

std::optional<double> FieldReader::operator()(Bytes message) const {
  WireCursor cursor(message);
  if (cursor.Integer(LcmPrimitive::kInt64) != fingerprint_) return std::nullopt;
  for (const Level& level : levels_) {
    Lengths lengths{};
    for (const Stride& stride : level.strides) {
      if (!cursor.Skip(stride.bytes)) return std::nullopt;
      if (stride.member != nullptr && !cursor.SkipMember(types_, *stride.member, lengths)) {
        return std::nullopt;
      }
    }
    const auto extent = cursor.ExtentOf(*level.target, lengths);
    if (!extent) return std::nullopt;
    const auto place = PlaceOf(level.indices, *extent);
    if (!place || !cursor.SkipElements(types_, *level.target, *place)) return std::nullopt;
  }
  const auto value = cursor.Number(*levels_.back().target->primitive);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace fogline::web
