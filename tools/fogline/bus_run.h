// A run over LCM: every role a node, in one process (memq) or as a process of its own (any URL).
#pragma once

#include <filesystem>
#include <vector>

#include "services/runtime/refusals.h"
#include "services/runtime/send_trouble.h"
#include "services/runtime/strangers.h"
#include "tools/fogline/experiment.h"

namespace fogline {

struct BusRun {
  std::int64_t run_id = 0;
  double wall_s = 0;
  std::int64_t repairs = 0;
  Refusals refused{};
  std::vector<SendTrouble> send_troubles;
  std::vector<Stranger> strangers;
  std::vector<Restarts> restarts;
};

/// A run id that no other run has.
std::int64_t DrawRunId();

/// Runs a scenario to its end and leaves its log.
/// @throws InputError, Interrupted, std::runtime_error as RunExperiment()
BusRun RunOnBus(const Scenario& scenario, const ExperimentOptions& options,
                const std::filesystem::path& log);

}  // namespace fogline
