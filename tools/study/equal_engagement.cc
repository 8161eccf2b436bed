#include "tools/study/equal_engagement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "tools/study/bootstrap.h"

namespace fogline {
namespace {

// Draws of the resamples. Streams below 1000 are those of roles, 1000 is the mix of situations.
constexpr Stream kSituations{1001};

CurvePoint PointOf(const RuleValues& rule, std::span<const double> weights) {
  return {.rhe_pct = WeightedMean(rule.rhe_pct, weights), .gain = WeightedMean(rule.gain, weights)};
}

std::vector<CurvePoint> CurveOf(std::span<const RuleValues> fixed,
                                std::span<const double> weights) {
  std::vector<CurvePoint> curve;
  for (const RuleValues& one : fixed) curve.push_back(PointOf(one, weights));
  return curve;
}

/// As BestAt(), of the curve's end where the RHE is beyond it.
double GainAt(std::span<const CurvePoint> curve, double rhe_pct) {
  const auto [least, most] = std::ranges::minmax(curve, {}, &CurvePoint::rhe_pct);
  const std::optional<CurvePlace> place =
      BestAt(curve, std::clamp(rhe_pct, least.rhe_pct, most.rhe_pct));
  return place ? place->gain : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::optional<CurvePlace> BestAt(std::span<const CurvePoint> curve, double rhe_pct) {
  std::optional<CurvePlace> best;
  const auto offer = [&](CurvePlace place) {
    if (!best || place.gain > best->gain) best = place;
  };
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (curve[i].rhe_pct == rhe_pct) offer({.below = i, .share = 0, .gain = curve[i].gain});
    if (i + 1 == curve.size()) break;
    const auto [from, to] = std::pair(curve[i], curve[i + 1]);
    const double share = (rhe_pct - from.rhe_pct) / (to.rhe_pct - from.rhe_pct);
    if (!(share > 0 && share < 1)) continue;  // also where the RHE stays as it is
    offer({.below = i, .share = share, .gain = std::lerp(from.gain, to.gain, share)});
  }
  return best;
}

std::vector<AtEqualEngagement> AgainstFixed(std::span<const RuleValues> fixed,
                                            std::span<const RuleValues> rules) {
  const std::size_t situations = fixed.front().rhe_pct.size();
  const std::vector<double> once(situations, 1.0);
  const std::vector<CurvePoint> curve = CurveOf(fixed, once);
  std::vector<AtEqualEngagement> all(rules.size());
  std::vector<double> values(rules.size());
  for (std::size_t r = 0; r < rules.size(); ++r) {
    const CurvePoint point = PointOf(rules[r], once);
    all[r].place = BestAt(curve, point.rhe_pct);
    if (all[r].place) values[r] = point.gain - all[r].place->gain;
  }
  const Resampling resampling(situations, kSituations);
  std::vector<std::vector<double>> replicates(rules.size());
  std::vector<double> weights;
  for (std::int64_t k = 0; k < kReplicates; ++k) {
    resampling.Draw(k, weights);
    const std::vector<CurvePoint> again = CurveOf(fixed, weights);
    for (std::size_t r = 0; r < rules.size(); ++r) {
      if (!all[r].place) continue;
      const CurvePoint point = PointOf(rules[r], weights);
      replicates[r].push_back(point.gain - GainAt(again, point.rhe_pct));
    }
  }
  for (std::size_t r = 0; r < rules.size(); ++r) {
    if (!all[r].place) continue;
    all[r].difference =
        FromReplicates(static_cast<std::int64_t>(situations), values[r], std::move(replicates[r]));
  }
  return all;
}

double LargestInterpolationError(std::span<const CurvePoint> curve) {
  double largest = 0;
  for (std::size_t i = 1; i + 1 < curve.size(); ++i) {
    const std::array neighbours{curve[i - 1], curve[i + 1]};
    const std::optional<CurvePlace> place = BestAt(neighbours, curve[i].rhe_pct);
    // Where the RHE stays as it is nothing is interpolated.
    if (!place || place->share == 0) continue;
    largest = std::max(largest, std::abs(place->gain - curve[i].gain));
  }
  return largest;
}

}  // namespace fogline
