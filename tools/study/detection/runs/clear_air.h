// Runs of detectors in clear air. Thresholds and rates of false alarms are computed from these
// runs.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "tools/study/detection/alarms.h"
#include "tools/study/detection/runs/sensed_runs.h"
#include "tools/study/study.h"

namespace fogline::study {

/// Length of a run in clear air after the warm-up, s.
inline constexpr double kClearRun_s = 115;
/// Length of the warm-up, s. At its end, the windows of the detectors are full, and the filter's
/// track has settled.
inline constexpr double kWarmUp_s = 5;
/// In clear air, every kClearStride-th step counts for ROC and AUC. The stride is longer than the
/// windows of 8 steps. So the counted steps are nearly independent.
inline constexpr std::int64_t kClearStride = 10;

/// Called when a unit of the runs is done; may throw StudyStopped.
using ShowUnit = std::function<void()>;

/// The runs to make in clear air.
struct ClearAirPlan {
  std::vector<std::size_t> detectors;  // indices in Detectors()
  std::int64_t first_seed = 0;         // seed of the first run; the next runs have the next seeds
  std::int64_t runs_per_seed = 1;      // number of runs for each of the study's seeds
  bool keeps_scores = false;           // whether to keep the scores of every kClearStride-th step
};

/// Makes the runs of the plan. The result has the runs of each detector, in the order of the plan's
/// detectors. The runs of a detector are in order of their seeds. Calls `show` each time the
/// `runs_per_seed` runs of a seed of the study are done. @throws what `show` throws
std::vector<std::vector<ClearRun>> RunClearAir(const StudyContext& context, const Traffic& traffic,
                                               const ClearAirPlan& plan, const ShowUnit& show);

}  // namespace fogline::study
