// Runs the rows of a sweep on all cores and delivers them in their order, within constant memory.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "services/closed_loop/closed_loop.h"
#include "services/metrics/fog_effect.h"
#include "services/metrics/run_metrics.h"
#include "services/metrics/safety_improvement.h"
#include "tools/sweep/plan.h"

namespace fogline::sweep {

/// Result of a row of a sweep.
struct SweepRow {
  metrics::RunMetrics measures;
  /// Measures of this run and its paired run together. They are empty for a run that is its own
  /// pair, or if the paired run has no compromised safety.
  metrics::PairedMetrics paired;
  /// The effect of the fog in the paired run without traded control; empty for a run that is its
  /// own pair.
  metrics::FogEffect without;
};

/// Runs a scenario. `baseline` has the samples of the paired run without traded control; it is
/// empty if the run has no traded control itself. If one run of the pair ends early, the measures
/// of the pair use only the steps that both runs have. @throws as ReusedLoop::Run()
SweepRow RunPaired(closed_loop::ReusedLoop& loop, const Scenario& scenario,
                   std::span<const metrics::Sample> baseline);

/// Computes units of a plan, one after another. Only one thread may use a worker. A worker keeps
/// its buffers from unit to unit.
class SweepWorker {
 public:
  explicit SweepWorker(const SweepPlan& plan) : plan_(plan), scenario_(plan.base()) {}

  /// The rows of a unit, in order. @throws InputError or std::runtime_error whose text names the
  /// row
  void Compute(std::int64_t unit, std::vector<SweepRow>& rows);

 private:
  /// The row of scenario_. Before the first row of a unit, ComputeRow() makes the paired run
  /// without traded control.
  SweepRow ComputeRow();

  const SweepPlan& plan_;
  Scenario scenario_;
  closed_loop::ReusedLoop loop_;
  std::vector<metrics::Sample> baseline_;
  metrics::FogEffect effect_;  // effect of the fog in the baseline
};

/// Takes the rows of a unit, in order of units. It returns false to stop.
using UnitConsumer = std::function<bool(std::int64_t unit, const std::vector<SweepRow>& rows)>;

/// Computes the units from `begin` up to, but not including, `end` on `jobs` threads. The consumer
/// gets the same rows for every value of `jobs`. An exception of the consumer reaches the caller.
/// If a row cannot be computed, the units before this row are delivered first. Then the exception
/// of the row reaches the caller.
void RunSweep(const SweepPlan& plan, std::int64_t begin, std::int64_t end, int jobs,
              const UnitConsumer& consume);

/// Number of threads that the machine can run at once.
int AllCores();

}  // namespace fogline::sweep
