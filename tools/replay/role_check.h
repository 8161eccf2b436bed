// Checks whether the algorithms of this program compute the same messages as the roles of a run.
// The inputs of each step come from the log, so a difference in one role does not affect another
// role.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/runtime/wire/other_build.h"
#include "tools/replay/role_replay.h"

namespace fogline::replay {

/// A role, and the result of computing its steps again.
struct RoleCheck {
  Role role;
  std::unique_ptr<RoleReplay> replay;
  std::int64_t steps_that_differ = 0;
  std::optional<Difference> first;  // `a` in the log, `b` computed here
};

/// The roles of a run that compute messages, in their initial state.
/// @param inputs inputs of the person who drove in the run
std::vector<RoleCheck> MakeRoleChecks(const log::RunLog& run, const log::DriverInputs& inputs = {});
/// Computes every step of a log again.
/// @throws InputError for a step that cannot be computed; the error text lacks the name of the log
void CheckRoles(log::RunLogReader& reader, std::vector<RoleCheck>& roles);

/// The result of a verification, which computes the steps of a run again from its log.
struct Verification {
  struct LeftOut {
    Role role;
    std::string why;
  };
  std::vector<Role> roles;        // roles that were computed again
  std::vector<LeftOut> left_out;  // roles that were not computed again
  struct Failure {
    Role role;
    Difference first;  // `a` in the log, `b` computed here
  };
  std::optional<Failure> failure;  // the earliest difference
  std::string broken;              // why a step could not be computed; "" if no step failed

  bool Holds() const { return !failure && broken.empty(); }
  /// The difference or the broken step, in one line; "" if the verification holds.
  std::string Trouble() const;
};

/// The roles whose build is unknown in the seal of a log, or is neither the build of this program
/// nor the build of the role's program in the folder of this program. The list is empty for a log
/// without a complete seal.
std::vector<runtime::OtherBuild> OtherBuildsIn(const log::RunLog& run);

/// Computes the steps of a run again from its log, and compares them with the log.
/// @param others roles of another build; they are left out, because their algorithms may differ
Verification VerifyRun(const std::filesystem::path& log, const log::RunLog& run,
                       const std::vector<runtime::OtherBuild>& others);

}  // namespace fogline::replay
