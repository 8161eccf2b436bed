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
  /// What the curve may be wrong by at the place (InterpolationErrorAt()), in units of gain.
  double interpolation_error = 0;
  /// The fixed threshold that gives most of those that engage at most as much; nullopt: none does.
  /// At an RHE of 0 the curve may jump, and this one is better than any place of equal RHE.
  std::optional<std::size_t> cheaper;
  /// Gain of the rule less that of the best fixed threshold of at most its RHE, with an interval as
  /// above; the threshold is chosen anew in each resample.
  Estimate against_cheaper;

  /// What can be said at equal RHE: an interval that is no farther from 0 than the curve may be
  /// wrong decides nothing.
  Verdict verdict() const;
};

/// Every rule beside the curve of the `fixed` ones, which are in order of threshold.
std::vector<AtEqualEngagement> AgainstFixed(std::span<const RuleValues> fixed,
                                            std::span<const RuleValues> rules);

/// The best point of the curve that engages at most this much; nullopt if none does.
std::optional<std::size_t> BestOfAtMost(std::span<const CurvePoint> curve, double rhe_pct);

/// What interpolation may be wrong by at a place of the curve. A fixed threshold at either end of
/// the stretch is some way off the curve of the others, on which its neighbours are twice as far
/// apart. A curve that bends once within the stretch, or steadily, errs by at most the larger of
/// these times 4 s (1 - s), s being the share of the way; at a point of the curve that is 0. Of a
/// stretch between two ends of the curve nothing is known, and the whole difference is taken.
double InterpolationErrorAt(std::span<const CurvePoint> curve, const CurvePlace& place);

}  // namespace fogline
