// A run over LCM. With memq, all roles are nodes in one process. With any other network, every role
// is a process of its own.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "services/runtime/coordination/foreign_peers.h"
#include "services/runtime/coordination/send_trouble.h"
#include "services/runtime/wire/refusals.h"
#include "tools/runner/log_sealer.h"
#include "tools/runner/scenario_run.h"

namespace fogline::runner {

struct BusRun {
  std::int64_t run_id = 0;
  double wall_s = 0;
  std::int64_t repairs = 0;
  runtime::Refusals refused{};
  std::vector<runtime::SendTrouble> send_troubles;
  std::vector<runtime::ForeignPeer> foreign_peers;
  std::vector<Restarts> restarts;
  std::optional<log::RealtimePriority> priority;  // only in real time, if the run has begun
  runtime::RoleBuilds builds{};                   // the builds that the roles have reported
  std::vector<runtime::OtherBuild> other_builds;  // the builds that differ from the runner's build
  std::vector<log::WrittenLog> written;           // the last report of each recorder about the log
};

/// A run id that no other run has.
std::int64_t DrawRunId();
/// The id of a new run: options.run_id if it is set, otherwise a random id.
inline std::int64_t RunIdOf(const RunOptions& options) {
  return options.run_id ? *options.run_id : DrawRunId();
}

/// Runs a scenario to its end and leaves the log of the run.
/// @param sealer seals the log of a run that ends early
/// @throws InputError, Interrupted, std::runtime_error like RunScenario()
BusRun RunOnBus(const Scenario& scenario, const RunOptions& options,
                const std::filesystem::path& log, const LogSealer& sealer);

}  // namespace fogline::runner
