// Compares the side that drives with the side that should drive. An oracle that knows the true gap
// says which side should drive.
#pragma once

#include <optional>

#include "scenario/sections/scenario.h"
#include "services/metrics/sample.h"
#include "services/metrics/track/track_judge.h"

namespace fogline::metrics {

/// In a step the LiDAR is *deceived* if it has a value with an error (LidarError) of more than a
/// tolerance. Otherwise the LiDAR is *right*; a LiDAR without a value counts as right. An *alarm*
/// lasts while the Degree of Conflict is at least the threshold of the step. The policy has no
/// effect on this definition.
struct DetectionMetrics {
  /// Time in which the human is the wrong driver, s: the time while the LiDAR is right, weighted by
  /// the human's authority.
  double wrong_human_s = 0;
  /// Time in which the automation is the wrong driver, s: the time while the track is wrong
  /// (TrackJudge), weighted by the automation's authority. A policy that does not use the deceived
  /// LiDAR can make this time 0, if the radar alone gives a right track. The time is above 0 for a
  /// policy that lets the automation drive again before the track is right again.
  double wrong_automation_s = 0;
  /// Time from the first step in which the LiDAR is deceived to the next step with an alarm, s. The
  /// time is 0 if the alarm has already begun, for example if fog raises the Degree of Conflict
  /// before the LiDAR's error exceeds the tolerance. nullopt if the LiDAR is never deceived, or if
  /// no alarm follows. `fogline study conflict` reports delays since the beginning of the fog.
  std::optional<double> deception_to_alarm_s;
  /// Number of alarms that begin in clear air while the LiDAR is right, per hour of clear air with
  /// a right LiDAR; nullopt if the run has no such time.
  std::optional<double> false_alarms_ph;
};

/// Error of the LiDAR's value, m. The error is the value minus the correct value. The correct value
/// has no noise and no fog, but has the LiDAR's bias and lateral offset. A gap below 0, after a
/// collision, counts as 0, and the correct value is never below 0. The error is below 0 if the
/// value is too short, and NaN without a value.
double LidarError(const Sample& sample, const LidarSection& lidar);

/// Collects the measures, step by step.
class DetectionAccumulator {
 public:
  explicit DetectionAccumulator(const Scenario& scenario);

  void Add(const Sample& sample);
  DetectionMetrics Result() const;

 private:
  bool IsDeceived(const Sample& sample) const;
  /// Adds the results of the previous step, which apply for `duration_s`.
  void Pass(double duration_s);

  double tolerance_m_;
  LidarSection lidar_;
  TrackJudge track_;

  bool begun_ = false;
  // Values of the previous step.
  double time_s_ = 0;
  bool alarm_ = false;
  bool quiet_ = false;  // clear air, and the LiDAR is right
  double wrong_human_ = 0;
  double wrong_automation_ = 0;

  DetectionMetrics metrics_;
  std::optional<double> onset_s_;
  double quiet_s_ = 0;
  double false_alarms_ = 0;
};

}  // namespace fogline::metrics
