// The difference of the two sensors, and its substitute if a sensor has no value. All measures of
// two sensors except lidar_modes use DisagreementSource, so that they treat missing values in the
// same way.
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
  /// of d if both sensors have the stated noise. The filter's prediction is not used for d, so its
  /// covariance is not in S.
  double variance_m2() const { return radar_std_m * radar_std_m + lidar_std_m * lidar_std_m; }
  /// d/sqrt(S): standard normal without a fault.
  double standardised() const;
};

class DisagreementSource {
 public:
  /// Treatment of ConflictParameters::offset_m: it is subtracted from the difference, or not.
  enum class Offset { kSubtracted, kKept };

  explicit DisagreementSource(const ConflictParameters& parameters,
                              Offset offset = Offset::kSubtracted);

  /// The disagreement of this step. The result for a step without radar or LiDAR value depends on
  /// the rule:
  ///   hold      the last measured disagreement; before the first one nullopt
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

  // Last stated standard deviations.
  double radar_std_m_;
  double lidar_std_m_;
  std::optional<Disagreement> measured_;  // the last measured disagreement
};

}  // namespace fogline::conflict
