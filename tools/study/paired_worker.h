// Makes runs that are compared with each other. The runs have the same seed and so the same noise.
// All of them are paired with one run without traded control.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenario/sections/scenario.h"
#include "tools/sweep/paired_runs.h"

namespace fogline::study {

/// The measures of a run in the order of ComparedMetrics(); NaN for a missing measure.
using RunValues = std::vector<double>;

/// Computes the values of runs. Only one thread may use a worker. A worker keeps its buffers
/// between calls, because allocating them again would take time.
class PairedWorker {
 public:
  /// Runs all `scenarios` with this seed. The first scenario has no traded control, and the other
  /// runs are paired with its run. @return the values of the other runs
  std::vector<RunValues> Compute(std::span<const Scenario> scenarios, std::int64_t seed);
  /// The values of the run without traded control from the latest Compute(). This run is paired
  /// with itself. A second run without traded control would give the same values, so it is not
  /// made.
  /// @param scenario the first scenario of the latest Compute()
  RunValues OfBaseline(const Scenario& scenario) const;

 private:
  sweep::PairedRuns runs_;
};

}  // namespace fogline::study
