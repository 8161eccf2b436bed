// Runs for the tests of measures, made by hand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "services/metrics/sample.h"

namespace fogline {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// The duration of a step. It is a power of two, so all times, integrals and jerks of a run are
// exact.
inline constexpr double kStep_s = 0.5;

// A run of `steps` steps without events. The following car is exactly at its safe distance.
inline std::vector<metrics::Sample> QuietRun(std::size_t steps) {
  std::vector<metrics::Sample> run(steps);
  for (std::size_t k = 0; k < steps; ++k) {
    run[k].step = static_cast<std::int64_t>(k);
    run[k].time_s = kStep_s * static_cast<double>(k);
    run[k].host_gap_m = run[k].fused_distance_m = 30;
    run[k].follower_gap_m = run[k].follower_safe_distance_m = 32;
  }
  return run;
}

// The run of QuietRun(), with fog in every step. In step k the following car is too near by
// shortfalls_m[k].
inline std::vector<metrics::Sample> FoggyRun(const std::vector<double>& shortfalls_m) {
  std::vector<metrics::Sample> run = QuietRun(shortfalls_m.size());
  for (std::size_t k = 0; k < run.size(); ++k) {
    run[k].fog_present = true;
    run[k].follower_gap_m -= shortfalls_m[k];
  }
  return run;
}

}  // namespace fogline
