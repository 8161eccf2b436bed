// Rules compared at equal redundant engagement. Fixed thresholds make a curve, what they give
// against the RHE that they cost; a rule is compared with the place of the curve that has its RHE.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tools/study/estimate.h"

namespace fogline {

/// What a fixed threshold costs and gives, in means.
struct CurvePoint {
  double rhe_pct;
  double gain;
};

/// A place of the curve, a share of the way from point `below` to the one after it.
struct CurvePlace {
  std::size_t below = 0;
  double share = 0;
  double gain = 0;
};

/// The best place of the curve, straight from point to point, that has this RHE. Several have it
/// where the RHE stays as it is: thresholds that no clear air passes. nullopt beyond the curve.
/// @param curve at least one point, in order of threshold
std::optional<CurvePlace> BestAt(std::span<const CurvePoint> curve, double rhe_pct);

/// One rule over the situations: NaN where a situation has none.
struct RuleValues {
  std::span<const double> rhe_pct;
  std::span<const double> gain;  // the more the better
};

/// A rule beside the curve.
struct AtEqualEngagement {
  std::optional<CurvePlace> place;  // nullopt: no fixed threshold engages as much, or as little
  /// Gain of the rule less that of the place. Its interval is a bootstrap over the situations in
  /// which curve, place and rule are made anew of every resample: it knows that equal situations
  /// have equal noise, and that the RHE of either side is an estimate. In a resample where the
  /// rule's RHE is beyond the curve, the curve's end is taken.
  Estimate difference;
};

/// Every rule beside the curve of the `fixed` ones, which are in order of threshold.
std::vector<AtEqualEngagement> AgainstFixed(std::span<const RuleValues> fixed,
                                            std::span<const RuleValues> rules);

/// What interpolation costs: how far, at most, a fixed threshold is from the curve of the others.
/// The curve of all errs by a fraction of that.
double LargestInterpolationError(std::span<const CurvePoint> curve);

}  // namespace fogline
