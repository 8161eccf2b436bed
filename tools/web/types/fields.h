// All numbers of a message type, by their paths: for finding a field by typing.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tools/web/types/lcm_types.h"

namespace fogline::web {

struct NumericField {
  std::string path;  // as FieldReader takes it
  std::string comment;
  std::string_view unit;  // "" if the name has no unit
};

/// How many elements NumericFields() lists at most of each dimension of an array.
struct ListedElements {
  std::size_t varying = 4;  // if the length varies: messages may have fewer or more
  std::size_t fixed = 64;
};

/// The numbers of a type in their order, those of structs in it too. Booleans and bytes count as
/// numbers, strings do not.
std::vector<NumericField> NumericFields(const LcmTypes& types, const LcmStruct& type,
                                        const ListedElements& listed = {});

}  // namespace fogline::web
