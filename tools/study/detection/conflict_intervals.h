// Intervals for the detection by detectors whose thresholds are estimates themselves.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tools/study/detection/alarms.h"
#include "tools/study/estimate.h"

namespace fogline::study {

/// Runs of one detector: those in clear air, from which its threshold is found, and the records of
/// its scores in fog, by visibility and seed.
struct DetectorRuns {
  std::span<const ClearRun> clear;
  std::span<const std::vector<ScoreRecords>> fog;
};

/// How detectors are compared.
struct DetectionRule {
  double arl_zero_s = 0;                   // mean time to a false alarm at the thresholds
  double missed_s = 0;                     // delay with which an undetected fog counts
  std::vector<std::size_t> ranked;         // the visibilities over which delays are averaged
  std::optional<std::size_t> reference{};  // the detector from which differences are taken
  int jobs = 1;
};

/// Detection in fog at a threshold.
struct DetectionMeans {
  struct InFog {
    Estimate delay_s;
    Estimate detection;  // probability
  };
  std::vector<InFog> by_visibility;
  Estimate delay_s;  // mean over the ranked visibilities; NaN if there is none
};

/// Detection by one detector, and its differences from the reference.
struct DetectionComparison {
  DetectionMeans detector;
  std::vector<Estimate> delay_minus_other_s;  // by visibility
  std::vector<double> mean_delays_s;          // of the resamples, over the ranked visibilities
};

/// The difference a - b of the mean delays over the ranked visibilities, with its interval.
Estimate DelayDifference(const DetectionComparison& a, const DetectionComparison& b);

/// Detection by each of `detectors`. Means use the thresholds that all runs give. Intervals come
/// from a bootstrap of both halves at once: it resamples the runs in clear air and finds a
/// threshold in them, and it resamples the seeds of the fog, with the same draws for all
/// visibilities and detectors. Detectors with equally many runs in clear air have the same draws of
/// these, too. If all or nearly all replicates have the same detection, the interval of Clopper and
/// Pearson is wider, and is used instead.
std::vector<DetectionComparison> CompareDetection(std::span<const DetectorRuns> detectors,
                                                  const DetectionRule& rule);

}  // namespace fogline::study
