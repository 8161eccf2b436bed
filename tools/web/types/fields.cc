#include "tools/web/types/fields.h"

#include <algorithm>

#include <fmt/core.h>

namespace fogline::web {
namespace {

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

std::vector<NumericField> NumericFields(const LcmTypes& types, const LcmStruct& type,
                                        const ListedElements& listed) {
  return Lister(types, listed).All(type);
}

}  // namespace fogline::web
