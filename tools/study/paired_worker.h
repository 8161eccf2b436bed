// Runs for comparison with one another: equal seeds give equal noise, and all share one run without
// traded control.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scenario/sections/scenario.h"
#include "services/metrics/closed_loop/closed_loop.h"
#include "services/metrics/sample.h"

namespace fogline::study {

/// The measures of a run in the order of ComparedMetrics(); NaN for a missing measure.
using RunValues = std::vector<double>;

/// For use by one thread; it keeps its buffers.
class PairedWorker {
 public:
  /// Runs all `scenarios` with this seed. The first scenario is the run without traded control,
  /// with which the others are paired. It is not in the result.
  std::vector<RunValues> Compute(std::span<const Scenario> scenarios, std::int64_t seed);

 private:
  template <class Visit>
  void Run(const Scenario& scenario, std::int64_t seed, Visit&& visit);

  std::optional<metrics::ClosedLoop> loop_;
  Scenario scenario_;
  std::vector<metrics::Sample> baseline_;
};

}  // namespace fogline::study
