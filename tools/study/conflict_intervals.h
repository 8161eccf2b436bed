// Intervals of what detectors do at thresholds that are estimates themselves.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tools/study/detectors.h"
#include "tools/study/estimate.h"

namespace fogline {

/// What is known of one measure: runs in clear air to find its threshold in, and the records of its
/// scores in fog, by visibility and seed.
struct DetectorRuns {
  std::span<const ClearRun> clear;
  std::span<const std::vector<ScoreRecords>> fog;
};

/// What a threshold comes to in fog.
struct DetectionMeans {
  struct InFog {
    Estimate delay_s;
    Estimate detection;  // probability
  };
  std::vector<InFog> by_visibility;
  Estimate delay_s;  // mean over the visibilities
};

/// Two measures at once: what they do, and the first less the second.
struct DetectionComparison {
  DetectionMeans detector;
  std::vector<Estimate> delay_minus_other_s;  // by visibility
  Estimate mean_delay_minus_other_s;
};

/// Detection by each of `detectors`, and against the one at `reference`, which may be none. A fog
/// that is missed has the delay `missed_s`. Means are those at the thresholds found in all runs.
/// Intervals are a bootstrap of both halves at once: the runs in clear air are drawn again and a
/// threshold is found in them, and the seeds of the fog are drawn again, the same for all
/// visibilities and measures. Where every replicate has the same detection, or nearly, the interval
/// of Clopper and Pearson is wider, and is taken.
std::vector<DetectionComparison> CompareDetection(std::span<const DetectorRuns> detectors,
                                                  std::optional<std::size_t> reference,
                                                  double arl_zero_s, double missed_s);

}  // namespace fogline
