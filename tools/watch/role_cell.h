// The column of roles in tables for the user.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "services/graph.h"

namespace fogline {

/// The name of a role, or a heading, with spaces behind it. The cells have the same width for all
/// roles of this build.
inline std::string RoleCell(std::string_view text) {
  constexpr std::size_t kWidth = 1 + std::ranges::max(kRoles, {}, [](const RoleInfo& info) {
                                       return info.name.size();
                                     }).name.size();
  return fmt::format("{:<{}}", text, kWidth);
}

}  // namespace fogline
