// Compares the side that drives with the side that should drive. An oracle that knows the true gap
// says which side should drive.
#pragma once

#include <optional>

#include "scenario/sections/scenario.h"
#include "services/metrics/sample.h"
#include "services/metrics/track/track_judge.h"

namespace fogline::metrics {

/// In a step the LiDAR is *deceived* if it has a value with an error (LidarError) of more than a
/// tolerance. Otherwise it is *right*; a LiDAR without a value counts as right. An *alarm* lasts
/// while the Degree of Conflict is at least the threshold in force, under any policy.
struct DetectionMetrics {
  /// Time under the wrong controller, s: time of the human while the LiDAR is right, weighted by
  /// his authority.
  double wrong_human_s = 0;
  /// Time of the automation, s, weighted by its authority, while the track is wrong (TrackJudge).
  /// So a policy that does not use the deceived LiDAR has no such time. A policy that returns the
  /// car to a filter that has not settled has such time.
  double wrong_automation_s = 0;
  /// Time from the first step in which the LiDAR is deceived to the first step with an alarm from
  /// then on, s. 0 if the alarm is already there, for example if fog raises the Degree of Conflict
  /// before the LiDAR's error exceeds the tolerance. nullopt if the LiDAR is never deceived, or if
  /// no alarm follows. `fogline study conflict` has delays that count from the begin of the fog.
  std::optional<double> deception_to_alarm_s;
  /// Alarms that begin in clear air while the LiDAR is right, per hour of such time; nullopt
  /// without such time.
  std::optional<double> false_alarms_ph;
};

/// Error of the LiDAR's value, m. It is the difference to the value without noise and fog for the
/// true gap, with the LiDAR's bias and lateral offset. Below 0 if the value is too short. NaN
/// without a value.
double LidarError(const Sample& sample, const LidarSection& lidar);

/// Collects the measures, step by step.
class DetectionAccumulator {
 public:
  explicit DetectionAccumulator(const Scenario& scenario);

  void Add(const Sample& sample);
  DetectionMetrics Result() const;

 private:
  bool IsDeceived(const Sample& sample) const;
  /// Adds the findings of the step before, which hold for `duration_s`.
  void Pass(double duration_s);

  double tolerance_m_;
  LidarSection lidar_;
  TrackJudge track_;

  bool begun_ = false;
  // Values of the step before.
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
