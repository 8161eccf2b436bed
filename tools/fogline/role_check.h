// Whether the roles of a run have computed what their algorithms compute here: each step's inputs
// are the log's, so what differs in one role does not carry over to another.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/runtime/other_build.h"
#include "tools/fogline/role_replay.h"

namespace fogline {

/// A role, and what has come of computing its steps again.
struct RoleCheck {
  Role role;
  std::unique_ptr<RoleReplay> replay;
  std::int64_t steps_that_differ = 0;
  std::optional<Difference> first;  // `a` in the log, `b` computed here
};

/// Every role that computes something, at the beginning of a run in lockstep.
std::vector<RoleCheck> MakeRoleChecks(const RunLog& run);
/// Computes every step of a log again.
/// @throws InputError for a step that cannot be computed, without the log's name
void CheckRoles(RunLogReader& reader, std::vector<RoleCheck>& roles);

/// The check of a run's own log.
struct Verification {
  struct LeftOut {
    Role role;
    std::string why;
  };
  std::vector<Role> roles;        // that were computed again
  std::vector<LeftOut> left_out;  // and those that could not be
  struct Failure {
    Role role;
    Difference first;  // `a` in the log, `b` computed here
  };
  std::optional<Failure> failure;  // the earliest one
  std::string broken;              // why a step could not be computed at all, "" if all could

  bool Holds() const { return !failure && broken.empty(); }
  /// What differs, one line; "" if nothing does.
  std::string Trouble() const;
};

/// The roles of which the seal of a log says that they were of another build than the programs
/// here, or does not say of which; none for a log without a seal.
std::vector<OtherBuild> OtherBuildsIn(const RunLog& run);

/// @param others roles of another build, whose algorithms are not here
Verification VerifyRun(const std::filesystem::path& log, const RunLog& run,
                       const std::vector<OtherBuild>& others);

}  // namespace fogline
