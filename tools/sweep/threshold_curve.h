// SI and RHE as functions of the arbitrator's threshold, over seeds. `fogline table` prints them
// and `fogline report` draws them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "scenario/sections/scenario.h"
#include "services/metrics/fog_effect.h"
#include "services/metrics/run_metrics.h"
#include "services/metrics/running.h"
#include "services/metrics/safety_improvement.h"
#include "tools/stats/statistics.h"
#include "tools/sweep/plan.h"

namespace fogline::sweep {

/// Result of the runs of all seeds with one threshold.
struct ThresholdRow {
  /// Adds the results of one seed: the measures of the run, the measures that compare the run with
  /// its paired run, and the effect of the fog in the paired run. SI may be missing, because it
  /// needs compromised safety in the paired run. RHE may be missing, because it needs clear air.
  void Add(const metrics::RunMetrics& measures, const metrics::PairedMetrics& paired,
           const metrics::FogEffect& without) {
    const auto add = [](const std::optional<double>& value, stats::Statistics& to) {
      if (value) to.Add(*value);
    };
    add(paired.si_pct, si_pct);
    add(paired.si_until_recovery_pct, si_until_recovery_pct);
    add(measures.rhe_pct, rhe_pct);
    add(measures.mean_compromised_safety_fog_m, cs_m);
    add(without.mean_compromised_safety_m, cs_without_m);
    add(without.slow_down_mps, slow_down_without_mps);
    for (std::size_t i = 0; i < other_si_pct.size(); ++i) {
      if (paired.other_si_pct[i]) other_si_pct[i].Add(*paired.other_si_pct[i]);
    }
    if (measures.collision != truth_t::COLLISION_NONE) ++collisions;
  }

  double threshold = 0;
  stats::Statistics si_pct;
  stats::Statistics rhe_pct;
  stats::Statistics si_until_recovery_pct;
  std::array<metrics::Mean, metrics::kSafetyChoices.size()> other_si_pct;
  // The effect of the fog: mean compromised safety in fog, with and without traded control, and the
  // loss of the host's speed in fog without traded control.
  stats::Statistics cs_m;
  stats::Statistics cs_without_m;
  stats::Statistics slow_down_without_mps;
  std::int64_t collisions = 0;  // runs with a collision
};

/// Refuses a scenario whose policy does not use the threshold, because all rows of its table would
/// be equal.
/// @param file source of the scenario, for messages
/// @throws InputError that names the policies which use the threshold
void RequireThreshold(const Scenario& scenario, const std::filesystem::path& file);

/// Called after every seed with the number of seeds done; returns false to stop.
using SeedsDone = std::function<bool(std::int64_t seeds)>;

/// Runs all seeds with every threshold and without traded control, on `jobs` threads. Rows are in
/// the order of `thresholds`. Every value of `jobs` gives the same rows, bit for bit. The rows are
/// incomplete if `done` stopped the work.
std::vector<ThresholdRow> SweepThresholds(const Scenario& scenario,
                                          std::span<const double> thresholds,
                                          const SeedRange& seeds, int jobs, const SeedsDone& done);

}  // namespace fogline::sweep
