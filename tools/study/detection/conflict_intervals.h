// Intervals for the results of detectors. The intervals take into account that the detectors'
// thresholds are estimates, too.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tools/study/detection/alarms.h"
#include "tools/study/estimate.h"

namespace fogline::study {

/// Runs of one detector. The threshold of the detector is found from the runs in clear air. `fog`
/// has the records of the scores in fog, by visibility and seed.
struct DetectorRuns {
  std::span<const ClearRun> clear;
  std::span<const std::vector<ScoreRecords>> fog;
};

/// Settings for the comparison of detectors.
struct DetectionRule {
  double arl_zero_s = 0;                   // mean time to a false alarm at the thresholds
  double missed_s = 0;                     // delay that is used for an undetected fog
  std::vector<std::size_t> ranked;         // indices of the visibilities whose delays are averaged
  std::optional<std::size_t> reference{};  // detector whose delay is subtracted from each delay
  int jobs = 1;
};

/// Results of a detector in fog, with one threshold.
struct DetectionMeans {
  struct InFog {
    Estimate delay_s;
    Estimate detection;  // probability that the fog is detected
  };
  std::vector<InFog> by_visibility;
  Estimate delay_s;  // mean over the ranked visibilities; NaN if no visibility is ranked
};

/// Detection by one detector, and the differences from the reference (DetectionRule::reference).
struct DetectionComparison {
  DetectionMeans detector;
  std::vector<Estimate> delay_minus_other_s;  // by visibility
  std::vector<double> mean_delays_s;          // one for each resample, over the ranked visibilities
};

/// The difference a - b of the mean delays over the ranked visibilities, with its interval.
Estimate DelayDifference(const DetectionComparison& a, const DetectionComparison& b);

/// Detection by each of `detectors`. Means use the thresholds from all runs in clear air. Intervals
/// come from a bootstrap over the runs in clear air and the runs in fog. Each replicate resamples
/// the runs in clear air, and finds a threshold from the resampled runs. It also resamples the
/// seeds in fog, with the same draws for all visibilities and detectors. Detectors with equally
/// many runs in clear air have the same draws of these runs, too. The interval of the probability
/// of detection is the smallest one that contains both the interval of the bootstrap and the exact
/// interval of Clopper and Pearson. So it is not too narrow if all or nearly all replicates have
/// the same detection.
std::vector<DetectionComparison> CompareDetection(std::span<const DetectorRuns> detectors,
                                                  const DetectionRule& rule);

}  // namespace fogline::study
