#include "services/runtime/wire/other_build.h"

#include <fmt/core.h>

namespace fogline::runtime {

std::string OtherBuild::Text() const {
  const std::string process = fmt::format("{} (pid {} on {})", NameOf(role), pid, host);
  if (build == kUnknownBuild) return process + " does not report its build";
  if (ours == kUnknownBuild) {
    return fmt::format(
        "{} is of build {}, and beside the runner is no fogline-{} to compare it with", process,
        BuildText(build), NameOf(role));
  }
  return fmt::format("{} is of build {}, but the runner is of build {}", process, BuildText(build),
                     BuildText(ours));
}

std::optional<OtherBuild> OtherBuildOf(Role role, const status_t& status, const RoleBuilds& ours) {
  const BuildId expected = ours[static_cast<std::size_t>(role)];
  if (status.build_id == expected && expected != kUnknownBuild) return std::nullopt;
  return OtherBuild{.role = role,
                    .pid = status.pid,
                    .host = status.host,
                    .build = status.build_id,
                    .ours = expected};
}

}  // namespace fogline::runtime
