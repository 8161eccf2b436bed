// Runs of detectors in clear air, from which thresholds and rates of false alarms come.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "tools/study/detection/alarms.h"
#include "tools/study/detection/sensed_runs.h"
#include "tools/study/study.h"

namespace fogline::study {

/// Length of a run in clear air after the warm-up, s.
inline constexpr double kClearRun_s = 115;
/// After this time filters and windows are full, and the track has settled, s.
inline constexpr double kWarmUp_s = 5;
/// One of this many steps in clear air counts for ROC and AUC. The number exceeds the windows of 8
/// steps, so that the counted steps are nearly independent.
inline constexpr std::int64_t kClearStride = 10;

/// Called when a unit of the runs is done; may throw StudyStopped.
using ShowUnit = std::function<void()>;

/// Which runs to make in clear air.
struct ClearAirPlan {
  std::vector<std::size_t> detectors;  // indices in Detectors()
  std::int64_t first_seed = 0;         // of the first of the study's seeds
  std::int64_t runs_per_seed = 1;      // with seeds one after the other
  bool keeps_scores = false;           // of every kClearStride-th step
};

/// The runs in order of their seeds, by detector in the order of the plan. Calls `show` after the
/// runs of each of the study's seeds. @throws as `show`
std::vector<std::vector<ClearRun>> RunClearAir(const StudyContext& context, const Traffic& traffic,
                                               const ClearAirPlan& plan, const ShowUnit& show);

}  // namespace fogline::study
