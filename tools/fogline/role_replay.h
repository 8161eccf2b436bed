// One role fed with what a log says that it has read, and its messages compared with those that the
// log says it has written. A run in lockstep is a function of its scenario, so they must be the
// same bit by bit, as long as the role computes what it did when the log was made.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "scenario/scenario.h"
#include "services/graph.h"
#include "services/recorder/run_log.h"
#include "tools/fogline/difference.h"

namespace fogline {

class RoleReplay {
 public:
  virtual ~RoleReplay() = default;

  /// Computes a step; call it for every step in order, from 0 on.
  /// @param messages of the step
  /// @param before those of the step before; not looked at in step 0
  /// @return the first difference, `a` in the log and `b` computed here
  /// @throws InputError for a message that is none, or that the role has no use for
  virtual std::optional<Difference> Step(std::int64_t step, const StepMessages& messages,
                                         const StepMessages& before) = 0;
};

/// The role of a run, at its beginning; nullptr for the recorder and the runner, which compute
/// nothing. @throws InputError for a scenario that cannot be
std::unique_ptr<RoleReplay> MakeRoleReplay(Role role, const RunLog& run);

}  // namespace fogline
