// The difference between radar and LiDAR, and the value that replaces the difference if a sensor
// has no value. All measures that compare only radar and LiDAR use DisagreementSource, except
// lidar_modes. So these measures treat missing values in the same way.
#pragma once

#include <optional>

#include "services/decision/conflict/conflict_measure.h"
#include "services/decision/conflict/conflict_parameters.h"

namespace fogline::conflict {

/// The difference d = radar - LiDAR of a step, with the standard deviations of both ranges. d is
/// above 0 if the LiDAR's range is too short, as in fog.
struct Disagreement {
  double difference_m;
  double radar_std_m;
  double lidar_std_m;

  /// S = s1^2 + s2^2, m2, with the standard deviations s1 and s2 of radar and LiDAR: the variance
  /// of d if both sensors have the stated noise. d does not depend on the filter's prediction, so S
  /// does not contain the variance of this prediction.
  double variance_m2() const { return radar_std_m * radar_std_m + lidar_std_m * lidar_std_m; }
  /// d/sqrt(S): standard normal without a fault.
  double standardised() const;
};

class DisagreementSource {
 public:
  /// Whether ConflictParameters::offset_m is subtracted from the difference.
  enum class Offset { kSubtracted, kKept };

  explicit DisagreementSource(const ConflictParameters& parameters,
                              Offset offset = Offset::kSubtracted);

  /// The disagreement of this step. If a sensor has no value in this step, the result depends on
  /// the rule (ConflictParameters::missing):
  ///   hold      the last measured disagreement; nullopt if no disagreement has been measured
  ///   skip      nullopt
  ///   conflict  d = missing_conflict_m, with the last stated standard deviations
  std::optional<Disagreement> Next(const Evidence& evidence);
  void Reset();

 private:
  MissingLidar missing_;
  double missing_conflict_m_;
  double offset_m_;
  double smallest_std_m_;
  double nominal_radar_std_m_;
  double nominal_lidar_std_m_;

  // The standard deviations that the sensors have stated last; nominal values before that.
  double radar_std_m_;
  double lidar_std_m_;
  std::optional<Disagreement> measured_;  // the last measured disagreement
};

}  // namespace fogline::conflict
