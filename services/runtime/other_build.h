// Whether the roles of a run are of the runner's build. Parts that were built from other sources
// compute other results, and message types that agree do not show it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "fogline/status_t.hpp"
#include "services/graph.h"
#include "services/runtime/build_id.h"

namespace fogline {

/// The build of each role's program beside the runner, by place in kRoles.
using RoleBuilds = std::array<BuildId, kRoles.size()>;

/// A process that is not of the runner's build, as far as is known.
struct OtherBuild {
  Role role;
  std::int32_t pid;
  std::string host;
  BuildId build;  // what it says
  BuildId ours;   // that of the role's program beside the runner

  /// "driver (pid 4711 on lab2) is of build 1f..., that of the runner is 2e...", or what is not
  /// known.
  std::string Text() const;
};

/// What a role's process says of its build; nothing if it is the runner's.
std::optional<OtherBuild> OtherBuildOf(Role role, const status_t& status, const RoleBuilds& ours);

}  // namespace fogline
