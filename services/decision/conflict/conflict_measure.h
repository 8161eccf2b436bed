// Interface of the measures of conflict between radar and LiDAR: the inputs of a step, and the
// result. The arbitrator decides what follows from a conflict.
#pragma once

namespace fogline::conflict {

/// A range with its stated standard deviation. All numbers are finite, also if it is not valid.
struct StatedRange {
  bool valid = false;  // false: no value in this step, and the other fields have no meaning
  double range_m = 0;  // m
  double std_m = 0;    // m, above 0; nominal: a standard deviation adapted to a bias hides conflict
};

/// The evidence of one step: two sensors, and a third witness.
struct Evidence {
  StatedRange radar;
  StatedRange lidar;
  /// The filter's range *before* it uses the two values above, and the standard deviation of this
  /// prediction alone (without the sensors' noise).
  StatedRange prediction;
};

/// A scalar score of conflict; a higher score means more conflict. The table (conflict_measures.h)
/// states unit, range and treatment of missing values for each measure. A measure reads no clock,
/// shares no state, and allocates no memory in Step: equal evidence gives equal scores, to the bit.
class ConflictMeasure {
 public:
  virtual ~ConflictMeasure() = default;

  /// The score after this step's evidence. Call it once per step.
  virtual double Step(const Evidence& evidence) = 0;
  /// Back to the state after construction: the same evidence gives the same scores again.
  virtual void Reset() = 0;
};

/// Blame of each sensor in [0, 1], similar to a probability. Both can be 0 (no conflict, or no
/// witness), and both can be high; their sum has no meaning.
struct Blame {
  double radar = 0;
  double lidar = 0;

  friend bool operator==(const Blame&, const Blame&) = default;
};

/// Finds the sensor that is wrong, for which two values alone are not enough. The contract is that
/// of ConflictMeasure.
class BlameMeasure {
 public:
  virtual ~BlameMeasure() = default;

  virtual Blame Step(const Evidence& evidence) = 0;
  virtual void Reset() = 0;
};

}  // namespace fogline::conflict
