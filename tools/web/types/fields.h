// The fields of a message type by their paths, such as "follower_gap_m[0]" or "header.step".
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tools/web/types/lcm_types.h"

namespace fogline::web {

/// One name of a path, and the indices behind it.
struct PathPart {
  std::string name;
  std::vector<std::size_t> indices;

  bool operator==(const PathPart&) const = default;
};

/// The parts of a path, which dots separate. @throws InputError
std::vector<PathPart> ParsePath(std::string_view path);

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

/// All numbers of a type in their order, for finding a field by typing, those of structs in it too.
/// Booleans and bytes count as numbers, strings do not.
std::vector<NumericField> NumericFields(const LcmTypes& types, const LcmStruct& type,
                                        const ListedElements& listed = {});

}  // namespace fogline::web
