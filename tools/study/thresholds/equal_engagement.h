// Compares rules at equal redundant human engagement (RHE). Fixed thresholds form a curve of gain
// over RHE. A rule is compared with the point of the curve that has the rule's RHE.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tools/study/estimate.h"

namespace fogline::study {

/// Mean RHE (the cost) and mean gain, such as SI, of a fixed threshold.
struct CurvePoint {
  double rhe_pct;
  double gain;
};

/// A place on the curve between point `below` and the next point. `share` is 0 at point `below` and
/// rises to 1 on the way to the next point.
struct CurvePlace {
  std::size_t below = 0;
  double share = 0;
  double gain = 0;
};

/// The place with this RHE on the curve. The curve is straight between its points. If several
/// places have this RHE, the result is the place with the largest gain. For example, all thresholds
/// that are never reached in clear air have the same RHE. nullopt if the RHE is beyond the curve.
/// @param curve at least one point, in order of threshold
std::optional<CurvePlace> BestAt(std::span<const CurvePoint> curve, double rhe_pct);

/// Values of one rule over the situations; NaN if a situation has no value.
struct RuleValues {
  std::span<const double> rhe_pct;
  std::span<const double> gain;  // more is better
};

/// Comparison of a rule with the curve.
struct AtEqualEngagement {
  std::optional<CurvePlace> place;  // nullopt if the rule's RHE is beyond the curve
  /// Gain of the rule minus gain of the place. The interval comes from a bootstrap over the
  /// situations. Curve, place and rule are computed again from the situations of each resample. So
  /// the interval takes into account that equal situations have equal noise, and that the RHEs of
  /// rule and curve are estimates. If the rule's RHE is beyond the curve of a resample, the end of
  /// the curve is used.
  Estimate difference;
  /// Possible error of the curve at the place (InterpolationErrorAt()), in units of gain.
  double interpolation_error = 0;

  /// Verdict at equal RHE. Both ends of the interval are first moved outwards by the possible error
  /// of the curve.
  Verdict verdict() const;
};

/// Compares every rule with the curve of the `fixed` rules. `fixed` is in order of threshold.
std::vector<AtEqualEngagement> AgainstFixed(std::span<const RuleValues> fixed,
                                            std::span<const RuleValues> rules);

/// Possible error of the interpolation at a place of the curve. The place is on a stretch between
/// two points. Each of these points has a distance in gain from the straight line between its own
/// neighbours. With h the length of the stretch and g the length of the other stretch at this
/// point, d is the larger value of distance max(1, (g + h)/(2 g)), and s is the place's `share`. If
/// the curve bends once within the stretch, or steadily, and both points have a distance, the error
/// is at most 4 s (1 - s) d. At a point of the curve the error is 0. If only one point has a
/// distance, its value is used. If neither has one, the difference in gain between the points is
/// used for d.
double InterpolationErrorAt(std::span<const CurvePoint> curve, const CurvePlace& place);

}  // namespace fogline::study
