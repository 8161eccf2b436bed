// Runs the rows of a sweep on all cores and delivers them in their order, within constant memory.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "scenario/sections/scenario.h"
#include "services/metrics/fog_effect.h"
#include "services/metrics/run_metrics.h"
#include "services/metrics/safety_improvement.h"
#include "tools/sweep/paired_runs.h"
#include "tools/sweep/plan.h"

namespace fogline::sweep {

/// Result of a row of a sweep.
struct SweepRow {
  metrics::RunMetrics measures;
  /// Measures that compare this run with its paired run. They are all empty for a run without
  /// traded control, because such a run is its own paired run. A measure is also empty if no step
  /// counts for it, for example because the paired run has no compromised safety in fog.
  metrics::PairedMetrics paired;
  /// The effect of the fog in the paired run, which has no traded control. Empty if this run itself
  /// has no traded control.
  metrics::FogEffect without;
};

/// Computes units of a plan, one after another. Only one thread may use a worker. A worker keeps
/// its buffers from unit to unit.
class SweepWorker {
 public:
  explicit SweepWorker(const SweepPlan& plan) : plan_(plan) {}

  /// The rows of a unit, in order. @throws InputError or std::runtime_error whose text names the
  /// row
  void Compute(std::int64_t unit, std::vector<SweepRow>& rows);

 private:
  /// Computes some rows of a unit together: from `begin` up to, but not including, `end`.
  void ComputeRows(std::int64_t unit, std::int64_t begin, std::int64_t end,
                   std::vector<SweepRow>& rows);

  const SweepPlan& plan_;
  /// The scenario without traded control, and the scenarios of the rows.
  std::vector<Scenario> scenarios_;
  PairedRuns runs_;
  std::int64_t row_ = 0;  // after an exception: the row that could not be computed
};

/// Called with the rows of each unit, in order of units; returns false to stop.
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
