// The runs of study `conflict`: fog models, visibilities and noises, with the detection by every
// measure of conflict in each.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/detection/detectors.h"
#include "tools/study/estimate.h"
#include "tools/study/study.h"

namespace fogline::study {

/// Visibilities from thin to dense fog, m (meteorological optical range). At about 95 m the LiDAR
/// in fog model beam loses a car 36 m ahead.
inline constexpr std::array kVisibilities_m{300.0, 150.0, 100.0, 75.0, 50.0};
/// Visibility at which the bias of fog model bias is that of paper.json, m.
inline constexpr double kReferenceVisibility_m = 60;
/// Mean time to a false alarm for which thresholds are calibrated, s: six false alarms an hour.
inline constexpr double kArlZero_s = 600;
/// Largest ratio of a threshold's mean time to kArlZero_s that still counts as equal.
inline constexpr double kLoosest = 1.5;
/// Number of batches of the runs in clear air and in fog. AUC and ROC compare the runs of equal
/// batches.
inline constexpr std::int64_t kBatches = 10;
/// Length of a run in clear air after the warm-up, s.
inline constexpr double kClearRun_s = 115;
/// One of this many steps in clear air counts for ROC and AUC. The number exceeds the windows of 8
/// steps, so that the counted steps are nearly independent.
inline constexpr std::int64_t kClearStride = 10;
/// Length of the fog in paper.json, s.
inline constexpr double kFog_s = 11;
/// The noise in figures and for the ROC.
inline constexpr std::string_view kUsualNoise = "near-range";
/// False positive rates for the ROC: shares of the steps in clear air.
inline constexpr std::array kFalsePositives{0.001, 0.002, 0.005, 0.01, 0.02,
                                            0.05,  0.1,   0.2,   0.5,  1.0};

struct ConflictCondition {
  std::string fog;  // bias or beam
  std::string noise;
  double visibility_m = 0;
};

/// Threshold of a measure for one fog model and noise.
struct DetectorThreshold {
  double threshold = 0;
  AlarmCount calibrated;  // in the runs from which it was found
  AlarmCount clear;       // in other runs in clear air

  /// Whether the threshold alarms as often as required. If a measure has its greatest value too
  /// often, or the time in clear air is too short, the smallest threshold that alarms seldom enough
  /// is never or hardly ever reached. Then the measure is not compared at equal false alarms.
  bool is_determined() const {
    return calibrated.alarms > 0 && calibrated.ArlZero_s() <= kLoosest * kArlZero_s;
  }
};

/// Results of one measure in one condition. A measure whose threshold is not determined has only
/// the results that need no threshold. The intervals take into account that thresholds are
/// estimates (conflict_intervals.h).
struct DetectorOutcome {
  Estimate delay_s;  // kFog_s for an undetected fog
  Estimate delay_minus_doc_s;
  std::int64_t detected = 0;       // number of seeds
  Estimate detection;              // probability
  double delay_if_detected_s = 0;  // mean; NaN without an alarm
  Estimate auc;
  Estimate auc_minus_doc;
  std::array<Estimate, kFalsePositives.size()> true_positives;
};

struct ConflictOutcome {
  ConflictCondition condition;
  std::vector<DetectorOutcome> detectors;  // in the order of ConflictMeasures()
};

/// Mean of one measure over the visibilities of a set.
struct DetectorMean {
  Estimate delay_s;
  Estimate delay_minus_doc_s;
  Estimate auc;
};

/// One fog model and one noise; their conditions share the thresholds.
struct ConflictSet {
  std::string fog;
  std::string noise;
  std::int64_t seeds = 0;
  std::vector<DetectorThreshold> thresholds;  // in the order of ConflictMeasures()
  std::vector<DetectorMean> means;            // in the same order
  std::vector<ConflictOutcome> outcomes;      // in the order of kVisibilities_m
};

/// All sets, by fog model, then by noise. @throws InputError, StudyStopped
std::vector<ConflictSet> RunConflictSets(const StudyContext& context);

/// Number of runs of all sets.
std::int64_t ConflictRuns(const StudyContext& context);

}  // namespace fogline::study
