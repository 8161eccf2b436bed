// The runs of study `conflict`: fog models, visibilities and noises, and how every measure of
// conflict does in each.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/detectors.h"
#include "tools/study/estimate.h"
#include "tools/study/study.h"

namespace fogline {

/// Visibilities from thin to dense fog, m (meteorological optical range). Around 95 m the LiDAR of
/// model beam loses a car 36 m ahead.
inline constexpr std::array kVisibilities_m{300.0, 150.0, 100.0, 75.0, 50.0};
/// Visibility at which fog model bias has the bias of paper.json, m.
inline constexpr double kReferenceVisibility_m = 60;
/// Mean time to a false alarm that thresholds are calibrated to, s: six false alarms an hour.
inline constexpr double kArlZero_s = 600;
/// How much longer the mean time of a threshold may be for it to count as equal.
inline constexpr double kLoosest = 1.5;
/// Parts of the runs in clear air and in fog that meet each other for AUC and ROC.
inline constexpr std::int64_t kBatches = 10;
/// Length of a run in clear air after the warm-up, s, and every how many of its steps count for ROC
/// and AUC: beyond the windows of 8 steps, so that they are nearly independent.
inline constexpr double kClearRun_s = 115;
inline constexpr std::int64_t kClearStride = 10;
/// Length of the fog in paper.json, s.
inline constexpr double kFog_s = 11;
/// The noise of figures and ROC.
inline constexpr std::string_view kUsualNoise = "near-range";
/// Shares of steps in clear air, for the ROC.
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
  AlarmCount calibrated;  // in the runs that it was found in
  AlarmCount clear;       // in other runs in clear air

  /// Whether it is one that alarms as often as was asked for. Where a measure is at its greatest
  /// value too often, or clear air too short, the least threshold that is quiet enough is one that
  /// is never or hardly ever reached: the measure then is not compared at equal false alarms.
  bool is_determined() const {
    return calibrated.alarms > 0 && calibrated.ArlZero_s() <= kLoosest * kArlZero_s;
  }
};

/// How one measure does in one condition. Of one whose threshold is not determined there is what
/// needs no threshold. Intervals know that thresholds are estimates (conflict_intervals.h).
struct DetectorOutcome {
  Estimate delay_s;  // kFog_s for a fog that is missed
  Estimate delay_minus_doc_s;
  std::int64_t detected = 0;       // seeds
  Estimate detection;              // probability
  double delay_if_detected_s = 0;  // mean; NaN if never
  Estimate auc;
  Estimate auc_minus_doc;
  std::array<Estimate, kFalsePositives.size()> true_positives;
};

struct ConflictOutcome {
  ConflictCondition condition;
  std::vector<DetectorOutcome> detectors;  // in the order of ConflictMeasures()
};

/// Mean over the visibilities of a set, of one measure.
struct DetectorMean {
  Estimate delay_s;
  Estimate delay_minus_doc_s;
  Estimate auc;
};

/// One fog model and noise, which have thresholds in common.
struct ConflictSet {
  std::string fog;
  std::string noise;
  std::int64_t seeds = 0;
  std::vector<DetectorThreshold> thresholds;  // in the order of ConflictMeasures()
  std::vector<DetectorMean> means;            // likewise
  std::vector<ConflictOutcome> outcomes;      // in the order of kVisibilities_m
};

/// All sets: by fog model, then noise. @throws InputError, StudyStopped
std::vector<ConflictSet> RunConflictSets(const StudyContext& context);

/// Runs that these are.
std::int64_t ConflictRuns(const StudyContext& context);

}  // namespace fogline
