// Passes the inputs from a log to one role, and compares the role's messages with the messages in
// the log. A run in lockstep is a function of its scenario. So the messages are equal bit by bit if
// the role computes in the same way as in the run.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "scenario/sections/scenario.h"
#include "services/graph.h"
#include "services/log/driver_inputs.h"
#include "services/log/run_log.h"
#include "tools/replay/difference.h"

namespace fogline::replay {

class RoleReplay {
 public:
  virtual ~RoleReplay() = default;

  /// Computes a step. Call it for every step in order, from 0 on.
  /// @param messages the messages of the step
  /// @param before the messages of the previous step; step 0 does not use them
  /// @return the first difference, `a` in the log and `b` computed here; nullopt if there is none.
  ///     In real time, also nullopt if a person drives and TRUTH or the command of the step is
  ///     missing.
  /// @throws InputError for an invalid message, or for a message that the role refuses
  virtual std::optional<Difference> Step(std::int64_t step, const log::StepMessages& messages,
                                         const log::StepMessages& before) = 0;
};

/// Makes a role of a run in its initial state. Returns nullptr for the recorder and the runner,
/// which compute nothing.
/// @param inputs inputs of the person who drove in the run
/// @throws InputError for an impossible scenario
std::unique_ptr<RoleReplay> MakeRoleReplay(Role role, const log::RunLog& run,
                                           const log::DriverInputs& inputs = {});

/// The names of the channels that a role reads or sends, but that the log does not have, because
/// another version of Fogline wrote the log; "" if there are none.
std::string MissingChannels(Role role, const log::RunLog& run);

/// Whether the log of a run has all data that a role's commands depend on.
bool CanReplay(Role role, const log::RunLog& run);

}  // namespace fogline::replay
