// The rows of `fogline table` and the curves of `fogline report`, computed with a progress bar.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tools/runner/scenario_run.h"
#include "tools/sweep/engine.h"
#include "tools/sweep/threshold_curve.h"

namespace fogline::cli {

/// SweepThresholds() with a progress bar. Call WatchInterrupts() before it.
/// @param jobs threads
/// @throws Interrupted after Ctrl-C
std::vector<sweep::ThresholdRow> RowsInMemory(const Scenario& scenario,
                                              std::span<const double> thresholds,
                                              const sweep::SeedRange& seeds,
                                              int jobs = sweep::AllCores());

/// How the runs of a table are made.
struct TableRuns {
  runner::RunOptions options;  // of each run, except its log
  std::filesystem::path logs;  // folder for a log of each run; empty: no logs
  std::string name;            // beginning of the name of each log
  int jobs = 1;                // number of runs at the same time
};

/// Makes each run of a table separately, by RunScenario(). Every number of jobs gives the same
/// rows, bit for bit. Call WatchInterrupts() before it.
/// @throws CheckFailed if a run fails its verification; all exceptions of RunScenario()
std::vector<sweep::ThresholdRow> RowsByRuns(const TableRuns& runs, const Scenario& scenario,
                                            std::span<const double> thresholds,
                                            const sweep::SeedRange& seeds);

}  // namespace fogline::cli
