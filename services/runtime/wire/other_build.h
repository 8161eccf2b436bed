// Checks whether the roles of a run have the runner's build. Programs built from other sources may
// compute other results, even if their message types agree.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "fogline/status_t.hpp"
#include "services/graph.h"
#include "services/runtime/wire/build_id.h"

namespace fogline::runtime {

/// The build of each role's program in the runner's folder, by index in kRoles.
using RoleBuilds = std::array<BuildId, kRoles.size()>;

/// A process whose build differs from the runner's build, or whose build cannot be compared.
struct OtherBuild {
  Role role;
  std::int32_t pid;
  std::string host;
  BuildId build;  // the build that the process reports
  BuildId ours;   // build of the role's program in the runner's folder

  /// Returns a text such as "driver (pid 4711 on lab2) is of build 1f..., but the runner is of
  /// build 2e...". If one of the builds is not known, the text says which build.
  std::string Text() const;
};

/// The process that sent `status` and its build, if this build differs from the expected build or
/// if one of the two builds is unknown; nullopt if both builds are known and equal.
/// @param ours the expected builds
std::optional<OtherBuild> OtherBuildOf(Role role, const status_t& status, const RoleBuilds& ours);

}  // namespace fogline::runtime
