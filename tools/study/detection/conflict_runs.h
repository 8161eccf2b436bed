// The runs of study `conflict`. A condition is a fog model, a visibility and a noise. Each
// condition has the results of every detector.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/detection/conflict_intervals.h"
#include "tools/study/detection/conflict_scenarios.h"
#include "tools/study/detection/detector_bank.h"
#include "tools/study/detection/runs/fog_runs.h"
#include "tools/study/detection/telling.h"
#include "tools/study/estimate.h"
#include "tools/study/study.h"

namespace fogline::study {

/// Visibilities from thin to dense fog, m (meteorological optical range). With the fog model `beam`
/// and a visibility of at most about 95 m, the LiDAR loses a car 36 m ahead.
inline constexpr std::array kVisibilities_m{300.0, 150.0, 100.0, 75.0, 50.0};
/// Mean time to a false alarm for which thresholds are calibrated, s: six false alarms an hour.
inline constexpr double kArlZero_s = 600;
/// If the mean time to a false alarm at a threshold is at most this multiple of kArlZero_s, the
/// threshold counts as calibrated.
inline constexpr double kLoosest = 1.5;
/// Number of runs in clear air for each seed, for the thresholds of quick detectors and of slow
/// detectors (detector_bank.h). If no condition of a ConflictSet ranks detectors, there is only one
/// run for each seed. A condition ranks detectors if their delays put them into an order
/// (telling.h).
inline constexpr std::int64_t kQuickClearAir = 100;
inline constexpr std::int64_t kSlowClearAir = 5;
/// First seeds of the runs in clear air. They are far from the seeds in fog, and from each other.
/// So the runs that give the thresholds differ from the runs in which false alarms are counted
/// again.
inline constexpr std::int64_t kCalibrationSeeds = 1'000'000'000;
inline constexpr std::int64_t kValidationSeeds = 2'000'000'000;
inline constexpr std::int64_t kFurtherClearAirSeeds = 3'000'000'000;

struct ConflictCondition {
  std::string fog;  // bias or beam
  std::string noise;
  double visibility_m = 0;
};

/// Threshold of a detector for one fog model and noise.
struct DetectorThreshold {
  double threshold = 0;
  AlarmCount calibrated;  // alarms in the runs from which the threshold was found
  AlarmCount clear;       // alarms in other runs in clear air

  /// Whether the threshold gives false alarms as often as required. A threshold cannot do this if a
  /// measure has its greatest value too often, or if the time in clear air is too short. Then the
  /// smallest threshold with few enough false alarms is never or hardly ever reached. A detector
  /// with such a threshold is not compared at equal false alarms.
  bool is_determined() const {
    return calibrated.alarms > 0 && calibrated.ArlZero_s() <= kLoosest * kArlZero_s;
  }
};

/// Results of one detector in one condition. A detector whose threshold is not determined has only
/// the results that need no threshold. The intervals take into account that thresholds are
/// estimates (conflict_intervals.h).
struct DetectorOutcome {
  Estimate delay_s;  // mean delay; an undetected fog counts as kFog_s
  Estimate delay_minus_doc_s;
  std::int64_t detected = 0;       // number of seeds with an alarm in fog
  Estimate detection;              // probability that the fog is detected
  double delay_if_detected_s = 0;  // mean delay of the alarms; NaN without an alarm
  Estimate auc;
  Estimate auc_minus_doc;
  std::array<Estimate, kFalsePositives.size()> true_positives;
};

struct ConflictOutcome {
  ConflictCondition condition;
  Telling telling = Telling::kRanks;
  std::vector<DetectorOutcome> detectors;  // in the order of Detectors()
};

/// All conditions with one fog model and one noise. These conditions share the thresholds. Vectors
/// of detectors are in the order of Detectors().
struct ConflictSet {
  std::string fog;
  std::string noise;
  std::int64_t seeds = 0;
  std::int64_t runs = 0;
  std::vector<DetectorThreshold> thresholds;
  /// Detectors with the same alarms count as one detector: one of them stands for all, and they all
  /// have its results. For each detector, this list has the index of the detector that stands for
  /// it. Any other detector stands for itself.
  std::vector<std::size_t> counts_as;
  /// Detection by the detectors that have a threshold. The mean delays are means over the
  /// conditions whose delays put the detectors into an order (telling.h).
  std::vector<DetectionComparison> compared;
  std::vector<Estimate> auc;              // mean over the visibilities
  std::vector<ConflictOutcome> outcomes;  // in the order of kVisibilities_m

  /// Whether the delays in at least one condition of the set put the detectors into an order
  /// (telling.h).
  bool Ranks() const;
  /// Whether the detector has a threshold at which it can be compared.
  bool IsCompared(std::size_t detector) const { return thresholds[detector].is_determined(); }
  const Estimate& DelayOf(std::size_t detector) const {
    return compared[detector].detector.delay_s;
  }
  /// The difference a - b of two mean delays; empty if one of the detectors has no threshold.
  Estimate Difference(std::size_t a, std::size_t b) const;
};

/// Runs all sets, and returns them by fog model, then by noise. @throws InputError, StudyStopped
std::vector<ConflictSet> RunConflictSets(const StudyContext& context);

/// A detector in bias fog with the usual noise. Its delay is a mean over all of kVisibilities_m.
struct DelayOutcome {
  bool is_compared = false;  // whether the detector has a threshold at which it can be compared
  DetectionComparison detection;
};

/// Number of runs in clear air for each seed in RunDelays(). The thresholds come from about four
/// false alarms for each seed, fewer than in RunConflictSets().
inline constexpr std::int64_t kDelayClearAir = 20;
/// Units of progress for each seed in RunDelays().
inline constexpr std::int64_t kDelayUnits = 1 + static_cast<std::int64_t>(kVisibilities_m.size());

/// Runs some detectors in bias fog with the usual noise, and with overrides of paper.json.
/// @param detectors indices in Detectors()
/// @param overrides changes of paper.json, but not of the fog model and the noise
/// @throws InputError, StudyStopped
std::vector<DelayOutcome> RunDelays(const StudyContext& context,
                                    std::span<const std::size_t> detectors,
                                    const std::vector<std::string>& overrides);

}  // namespace fogline::study
