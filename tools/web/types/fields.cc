#include "tools/web/types/fields.h"

#include <algorithm>
#include <charconv>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"

namespace fogline::web {
namespace {

[[noreturn]] void Fail(std::string_view path) {
  throw InputError(fmt::format(
      "{} is no field: write a field like \"host_gap_m\", \"header.step\" or \"follower_gap_m[0]\"",
      QuoteShort(path)));
}

/// Reads "[INDEX]" from the front of `text`.
std::size_t TakeIndex(std::string_view path, std::string_view& text) {
  std::size_t index = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + 1, end, index);
  if (error != std::errc() || stop == end || *stop != ']') Fail(path);
  text.remove_prefix(static_cast<std::size_t>(stop + 1 - text.data()));
  return index;
}

class Lister {
 public:
  Lister(const LcmTypes& types, const ListedElements& listed) : types_(types), listed_(listed) {}

  std::vector<NumericField> All(const LcmStruct& type) {
    Struct(type, "");
    return std::move(fields_);
  }

 private:
  void Struct(const LcmStruct& type, const std::string& prefix) {
    for (const LcmMember& member : type.members) Array(member, prefix + member.name, 0);
  }

  void Array(const LcmMember& member, const std::string& path, std::size_t dimension) {
    if (dimension == member.dimensions.size()) return Element(member, path);
    const auto& fixed = member.dimensions[dimension].fixed;
    const std::size_t count = fixed ? std::min(*fixed, listed_.fixed) : listed_.varying;
    for (std::size_t i = 0; i < count; ++i) {
      Array(member, fmt::format("{}[{}]", path, i), dimension + 1);
    }
  }

  void Element(const LcmMember& member, const std::string& path) {
    if (!member.primitive) return Struct(types_.StructOf(member), path + ".");
    if (*member.primitive == LcmPrimitive::kString) return;
    fields_.push_back({.path = path, .comment = member.comment, .unit = UnitOf(member.name)});
  }

  const LcmTypes& types_;
  ListedElements listed_;
  std::vector<NumericField> fields_;
};

}  // namespace

std::vector<PathPart> ParsePath(std::string_view path) {
  std::vector<PathPart> parts;
  std::string_view rest = path;
  while (true) {
    PathPart& part = parts.emplace_back();
    const std::size_t length = std::min(rest.find_first_of(".[]"), rest.size());
    if (length == 0) Fail(path);
    part.name = rest.substr(0, length);
    rest.remove_prefix(length);
    while (rest.starts_with('[')) part.indices.push_back(TakeIndex(path, rest));
    if (rest.empty()) return parts;
    if (!rest.starts_with('.')) Fail(path);
    rest.remove_prefix(1);
  }
}

std::vector<NumericField> NumericFields(const LcmTypes& types, const LcmStruct& type,
                                        const ListedElements& listed) {
  return Lister(types, listed).All(type);
}

}  // namespace fogline::web
