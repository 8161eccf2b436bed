// The paths of fields in a message type, such as "follower_gap_m[0]" or "header.step".
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fogline::web {

/// One name of a path, and the indices after it.
struct PathPart {
  std::string name;
  std::vector<std::size_t> indices;

  bool operator==(const PathPart&) const = default;
};

/// The parts of a path, which dots separate. @throws InputError
std::vector<PathPart> ParsePath(std::string_view path);

}  // namespace fogline::web
