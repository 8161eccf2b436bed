// Who drives against who should: what an oracle that knows the true gap makes of a run.
#pragma once

#include <optional>

#include "scenario/scenario.h"
#include "services/measures/sample.h"

namespace fogline {

/// In a step the LiDAR is *deceived* if it has a value that is off by more than a tolerance: off
/// what it would read, mounted as it is, of the true gap. Otherwise it is *right*; a LiDAR without
/// a value deceives nobody. An *alarm* lasts while the Degree of Conflict is at least the threshold
/// in force, whatever the policy then makes of it.
struct DetectionMeasures {
  /// Time under the wrong controller, s, weighed by authority: of the human while the LiDAR is
  /// right, ...
  double wrong_human_s = 0;
  /// ... and of the automation while the LiDAR is deceived and the fused distance is off by more
  /// than the tolerance too. A policy that does without the deceived LiDAR is not blamed for it.
  double wrong_automation_s = 0;
  /// From the first step in which the LiDAR is deceived to the first one of an alarm from there on,
  /// s: 0 if the alarm lasts already, as where fog shows in the Degree of Conflict before the LiDAR
  /// is off by the tolerance. nullopt if it never is deceived, or if no alarm follows. Delays that
  /// count from the begin of the fog are those of `fogline study conflict`.
  std::optional<double> deception_to_alarm_s;
  /// Alarms that begin in clear air with a LiDAR that is right, per hour of that; nullopt without
  /// such time.
  std::optional<double> false_alarms_ph;
};

/// How far the LiDAR's value is from what it would read, mounted as it is, of the true gap, m:
/// below 0 where it reads short. NaN without a value.
double LidarError(const Sample& sample, const LidarSection& lidar);

/// Collects them, step by step.
class DetectionAccumulator {
 public:
  explicit DetectionAccumulator(const Scenario& scenario);

  void Add(const Sample& sample);
  DetectionMeasures Result() const;

 private:
  bool IsDeceived(const Sample& sample) const;
  /// Integrates what was found at the step before.
  void Pass(double duration_s);

  double tolerance_m_;
  LidarSection lidar_;

  bool begun_ = false;
  // Of the step before.
  double time_s_ = 0;
  bool alarm_ = false;
  bool quiet_ = false;  // clear air, and a LiDAR that is right
  double wrong_human_ = 0;
  double wrong_automation_ = 0;

  DetectionMeasures measures_;
  std::optional<double> onset_s_;
  double quiet_s_ = 0;
  double false_alarms_ = 0;
};

}  // namespace fogline
