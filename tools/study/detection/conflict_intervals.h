// Intervals for the detection by detectors whose thresholds are estimates themselves.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tools/study/detection/detectors.h"
#include "tools/study/estimate.h"

namespace fogline::study {

/// Runs of one measure: those in clear air, from which its threshold is found, and the records of
/// its scores in fog, by visibility and seed.
struct DetectorRuns {
  std::span<const ClearRun> clear;
  std::span<const std::vector<ScoreRecords>> fog;
};

/// Detection in fog at a threshold.
struct DetectionMeans {
  struct InFog {
    Estimate delay_s;
    Estimate detection;  // probability
  };
  std::vector<InFog> by_visibility;
  Estimate delay_s;  // mean over the visibilities
};

/// Detection by one measure, and its differences from the reference measure.
struct DetectionComparison {
  DetectionMeans detector;
  std::vector<Estimate> delay_minus_other_s;  // by visibility
  Estimate mean_delay_minus_other_s;
};

/// Detection by each of `detectors`, and its difference from the detector at `reference`
/// (optional). An undetected fog counts with the delay `missed_s`. Means use the thresholds that
/// all runs give. Intervals come from a bootstrap of both halves at once: it resamples the runs in
/// clear air and finds a threshold in them, and it resamples the seeds of the fog, with the same
/// draws for all visibilities and measures. If all or nearly all replicates have the same
/// detection, the interval of Clopper and Pearson is wider, and is used instead.
std::vector<DetectionComparison> CompareDetection(std::span<const DetectorRuns> detectors,
                                                  std::optional<std::size_t> reference,
                                                  double arl_zero_s, double missed_s);

}  // namespace fogline::study
