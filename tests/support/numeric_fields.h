// All numbers of a message type, for tests of code that reads these numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "tools/web/types/lcm_types.h"

namespace fogline::test {

/// The number of elements that NumericFields lists for a dimension of an array.
struct ListedElements {
  std::size_t varying = 4;  // for a dimension of varying length; a message may have fewer or more
  std::size_t fixed = 64;
};

/// The paths of all numbers of a type in their order. Numbers of nested structs are included.
/// Booleans and bytes count as numbers, strings do not.
class NumericFields {
 public:
  NumericFields(const web::LcmTypes& types, const web::LcmStruct& type,
                const ListedElements& listed = {})
      : types_(types), listed_(listed) {
    Struct(type, "");
  }
  const std::vector<std::string>& paths() const { return paths_; }

 private:
  void Struct(const web::LcmStruct& type, const std::string& prefix) {
    for (const web::LcmMember& member : type.members) Array(member, prefix + member.name, 0);
  }

  void Array(const web::LcmMember& member, const std::string& path, std::size_t dimension) {
    if (dimension == member.dimensions.size()) return Element(member, path);
    const auto& fixed = member.dimensions[dimension].fixed;
    const std::size_t count = fixed ? std::min(*fixed, listed_.fixed) : listed_.varying;
    for (std::size_t i = 0; i < count; ++i) {
      Array(member, fmt::format("{}[{}]", path, i), dimension + 1);
    }
  }

  void Element(const web::LcmMember& member, const std::string& path) {
    if (!member.primitive) return Struct(types_.StructOf(member), path + ".");
    if (*member.primitive != web::LcmPrimitive::kString) paths_.push_back(path);
  }

  const web::LcmTypes& types_;
  const ListedElements listed_;
  std::vector<std::string> paths_;
};

}  // namespace fogline::test
