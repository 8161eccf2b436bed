// Runs that are compared with one another: equal seeds, equal noise, one run without traded control
// for all of them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scenario/scenario.h"
#include "services/closed_loop/closed_loop.h"
#include "services/measures/sample.h"

namespace fogline {

/// The measures of a run in the order of ComparedMeasures(); NaN where it has none.
using RunValues = std::vector<double>;

/// For one thread. Keeps its buffers.
class PairedWorker {
 public:
  /// Runs all `scenarios` with this seed. The first is the one without traded control that the
  /// others are paired with; it is not in the result.
  std::vector<RunValues> Compute(std::span<const Scenario> scenarios, std::int64_t seed);

 private:
  template <class Visit>
  void Run(const Scenario& scenario, std::int64_t seed, Visit&& visit);

  std::optional<ClosedLoop> loop_;
  Scenario scenario_;
  std::vector<Sample> baseline_;
};

}  // namespace fogline
