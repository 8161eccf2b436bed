// SI and RHE against the arbitrator's threshold, over seeds: what `fogline table` prints and
// `fogline report` draws.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "scenario/scenario.h"
#include "services/measures/measures.h"
#include "tools/sweep/plan.h"
#include "tools/sweep/statistics.h"

namespace fogline {

/// What the runs of all seeds with one threshold come to.
struct ThresholdRow {
  /// Adds a run. SI and RHE may be missing: SI needs compromised safety in the paired run.
  void Add(const std::optional<double>& si, const RunMeasures& measures) {
    if (si) si_pct.Add(*si);
    if (measures.rhe_pct) rhe_pct.Add(*measures.rhe_pct);
    if (measures.collision != truth_t::COLLISION_NONE) ++collisions;
  }

  double threshold = 0;
  Statistics si_pct;
  Statistics rhe_pct;
  std::int64_t collisions = 0;  // runs with one
};

/// Refuses a scenario whose policy pays no heed to the threshold: its rows would all be the same.
/// @param file where it comes from
/// @throws InputError that names the policies which do
void RequireThreshold(const Scenario& scenario, const std::filesystem::path& file);

/// Called after every seed with the number of seeds done; returns false to stop.
using SeedsDone = std::function<bool(std::int64_t seeds)>;

/// Runs all seeds with every threshold and without traded control, on `jobs` threads. Rows are in
/// the order of `thresholds`; not a bit of them depends on `jobs`. Incomplete if stopped.
std::vector<ThresholdRow> SweepThresholds(const Scenario& scenario,
                                          std::span<const double> thresholds,
                                          const SeedRange& seeds, int jobs, const SeedsDone& done);

}  // namespace fogline
