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
/// that are never reached in clear air have the same RHE. The result is nullopt if the RHE is
/// beyond the curve.
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

  /// Verdict at equal RHE. Both ends of the interval of `difference` are first moved outwards by
  /// interpolation_error.
  Verdict verdict() const;
};

/// Compares every rule with the curve of the `fixed` rules. `fixed` is in order of threshold.
std::vector<AtEqualEngagement> AgainstFixed(std::span<const RuleValues> fixed,
                                            std::span<const RuleValues> rules);

/// Possible error of the interpolation at a place of the curve. At a point of the curve the error
/// is 0. Any other place is between two points of the curve. For each of these two points:
/// - e is the distance in gain between the point and the straight line between its own two
///   neighbours. Some points have no e, such as the ends of the curve.
/// - h is the difference in RHE between the two points.
/// - g is the difference in RHE between the point and its neighbour on the other side.
///
/// The result is 4 s (1 - s) d, where s is the place's `share`, and d is the larger of the two
/// values e max(1, (g + h)/(2 g)). If only one point has an e, d is the value of this point. If no
/// point has an e, d is the difference in gain between the two points. The error is at most this
/// result under two conditions: both points have an e, and the curve between the two points bends
/// once or bends steadily.
double InterpolationErrorAt(std::span<const CurvePoint> curve, const CurvePlace& place);

}  // namespace fogline::study
