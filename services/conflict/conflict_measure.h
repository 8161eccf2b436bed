// What a measure of conflict between radar and LiDAR sees in a step, and what it answers. What to
// do about a conflict is decided elsewhere.
#pragma once

namespace fogline {

/// A range with its stated standard deviation. Finite, also where it is not valid: NaN never.
struct StatedRange {
  bool valid = false;  // false: no value in this step, the other fields are of no meaning
  double range_m = 0;  // m
  double std_m = 0;    // m, above 0; nominal, not adapted: a filter that learns it hides conflict
};

/// The evidence of one step: two sensors, and a third witness.
struct Evidence {
  StatedRange radar;
  StatedRange lidar;
  /// The filter's range *before* it has seen the two values above, and the standard deviation of
  /// that prediction alone (without the sensors' noise).
  StatedRange prediction;
};

/// A scalar score of conflict: the higher, the more. Unit, range, and what becomes of a missing
/// value are the measure's own and stand in the table (measures.h). A measure reads no clock,
/// shares nothing, and allocates nothing in Step: equal evidence gives equal scores, to the bit.
class ConflictMeasure {
 public:
  virtual ~ConflictMeasure() = default;

  /// The score after this step's evidence. Once per step.
  virtual double Step(const Evidence& evidence) = 0;
  /// As constructed: the same evidence gives the same scores again.
  virtual void Reset() = 0;
};

/// How strongly each sensor is to blame, in [0, 1], like a probability. Both can be 0 (no conflict,
/// or no witness), and both can be high; they do not add up to anything.
struct Blame {
  double radar = 0;
  double lidar = 0;

  friend bool operator==(const Blame&, const Blame&) = default;
};

/// Says which sensor is wrong, which two values alone can't. The contract is that of
/// ConflictMeasure.
class BlameMeasure {
 public:
  virtual ~BlameMeasure() = default;

  virtual Blame Step(const Evidence& evidence) = 0;
  virtual void Reset() = 0;
};

}  // namespace fogline
