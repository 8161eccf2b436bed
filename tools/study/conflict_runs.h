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

/// How one measure does in one condition.
struct DetectorOutcome {
  double threshold = 0;
  AlarmCount calibrated;  // in the runs that the threshold was found in
  AlarmCount clear;       // in other runs in clear air
  // Seed by seed.
  std::vector<double> delay_s;  // kFog_s for a fog that is missed
  std::vector<double> auc;
  std::array<std::vector<double>, kFalsePositives.size()> true_positives;
  std::int64_t detected = 0;       // seeds
  double delay_if_detected_s = 0;  // mean; NaN if never
};

struct ConflictOutcome {
  ConflictCondition condition;
  std::vector<DetectorOutcome> detectors;  // in the order of ConflictMeasures()
};

/// All conditions: by fog model, then noise, then visibility. @throws InputError, StudyStopped
std::vector<ConflictOutcome> RunConflictConditions(const StudyContext& context);

/// Runs that these are.
std::int64_t ConflictRuns(const StudyContext& context);

}  // namespace fogline
