// Interface of the measures of conflict between radar and LiDAR: the inputs of a step, and the
// result. The arbitrator decides how the host reacts to a conflict.
#pragma once

namespace fogline::conflict {

/// A range with its stated standard deviation. This standard deviation should not grow with the
/// errors of the range, because a larger standard deviation hides a conflict. All numbers are
/// finite, even if `valid` is false.
struct StatedRange {
  bool valid = false;  // false: no value in this step; other fields have no meaning
  double range_m = 0;  // m
  double std_m = 0;    // m, above 0
};

/// The evidence of one step: the ranges that radar and LiDAR measure, and the range that the filter
/// predicts.
struct Evidence {
  StatedRange radar;
  StatedRange lidar;
  /// The range that the filter predicts *before* it uses the values of radar and LiDAR, and the
  /// standard deviation of this prediction alone (without the sensors' noise).
  StatedRange prediction;
};

/// A scalar score of conflict; a higher score means more conflict. The table (conflict_measures.h)
/// states unit, range and treatment of missing values for each measure. A measure reads no clock,
/// shares no state, and allocates no memory in Step. So equal evidence gives equal scores, bit by
/// bit.
class ConflictMeasure {
 public:
  virtual ~ConflictMeasure() = default;

  /// The score after this step's evidence. Call Step() once per step.
  virtual double Step(const Evidence& evidence) = 0;
  /// Returns to the state after construction, so that the same evidence gives the same scores
  /// again.
  virtual void Reset() = 0;
};

/// Blame of each sensor in [0, 1], similar to a probability. Both values can be 0 (no conflict, or
/// no prediction), and both can be high. Their sum has no meaning.
struct Blame {
  double radar = 0;
  double lidar = 0;
  /// Above 0 if the radar is more wrong than the LiDAR, below 0 if the LiDAR is more wrong. If both
  /// blames round to 1, their difference is 0 and does not show which sensor is more wrong. So a
  /// measure can set this number in another way.
  double radar_excess = radar - lidar;

  friend bool operator==(const Blame&, const Blame&) = default;
};

/// A measure that finds the sensor that is wrong. The values of radar and LiDAR alone do not show
/// which sensor is wrong, so a measure of blame also uses the prediction. The rules of
/// ConflictMeasure (no clock, no shared state, no allocation in Step) apply.
class BlameMeasure {
 public:
  virtual ~BlameMeasure() = default;

  virtual Blame Step(const Evidence& evidence) = 0;
  virtual void Reset() = 0;
};

}  // namespace fogline::conflict
