// Compares rules at equal redundant engagement. Fixed thresholds form a curve of gain over RHE. A
// rule is compared with the point of the curve that has its RHE.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tools/study/estimate.h"

namespace fogline::study {

/// Mean cost and mean gain of a fixed threshold.
struct CurvePoint {
  double rhe_pct;
  double gain;
};

/// A place on the curve: a share of the way from point `below` to the next point.
struct CurvePlace {
  std::size_t below = 0;
  double share = 0;
  double gain = 0;
};

/// The best place with this RHE on the curve, which is straight between its points. Several places
/// have it where the RHE is constant: thresholds that clear air never passes. nullopt beyond the
/// curve.
/// @param curve at least one point, in order of threshold
std::optional<CurvePlace> BestAt(std::span<const CurvePoint> curve, double rhe_pct);

/// Values of one rule over the situations; NaN where a situation has none.
struct RuleValues {
  std::span<const double> rhe_pct;
  std::span<const double> gain;  // more is better
};

/// Comparison of a rule with the curve.
struct AtEqualEngagement {
  std::optional<CurvePlace> place;  // nullopt: no fixed threshold engages as much, or none as
                                    // little
  /// Gain of the rule minus gain of the place. Its interval is a bootstrap over the situations.
  /// Each resample computes curve, place and rule from its own situations. So the interval takes
  /// into account that equal situations have equal noise, and that both RHE are estimates. If the
  /// rule's RHE is beyond the curve of a resample, the end of the curve counts.
  Estimate difference;
  /// Possible error of the curve at the place (InterpolationErrorAt()), in units of gain.
  double interpolation_error = 0;

  /// Verdict at equal RHE. It is undecided if the interval comes as close to 0 as the possible
  /// error of the curve.
  Verdict verdict() const;
};

/// Compares every rule with the curve of the `fixed` ones, which are in order of threshold.
std::vector<AtEqualEngagement> AgainstFixed(std::span<const RuleValues> fixed,
                                            std::span<const RuleValues> rules);

/// Possible error of the interpolation at a place of the curve. A fixed threshold at either end of
/// the stretch has a distance from the curve of the other points, on which its neighbours are twice
/// as far apart. If the curve bends once within the stretch, or steadily, the error is at most the
/// larger of these two distances times 4 s (1 - s), where s is the share of the way. At a point of
/// the curve it is 0. For a stretch between two ends of the curve the error is unknown, and the
/// whole difference counts.
double InterpolationErrorAt(std::span<const CurvePoint> curve, const CurvePlace& place);

}  // namespace fogline::study
