#include "tools/study/thresholds/equal_engagement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tools/stats/statistics.h"
#include "tools/study/bootstrap.h"

namespace fogline::study {
namespace {

// Random stream of the resamples. Streams below 1000 belong to roles. Stream 1000 belongs to the
// mix of situations.
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

/// The gain of BestAt(). An RHE beyond the curve is moved to the nearer end of the curve.
double GainAt(std::span<const CurvePoint> curve, double rhe_pct) {
  const auto [least, most] = std::ranges::minmax(curve, {}, &CurvePoint::rhe_pct);
  const std::optional<CurvePlace> place =
      BestAt(curve, std::clamp(rhe_pct, least.rhe_pct, most.rhe_pct));
  return place ? place->gain : stats::kMissing;
}

/// Distance in gain between a point of the curve and the straight line between its two neighbours.
/// The result is nullopt at the ends of the curve, and if the RHE of the point is not between the
/// RHEs of its neighbours.
std::optional<double> OffTheOthers(std::span<const CurvePoint> curve, std::size_t point) {
  if (point == 0 || point + 1 >= curve.size()) return std::nullopt;
  const std::array neighbours{curve[point - 1], curve[point + 1]};
  const std::optional<CurvePlace> place = BestAt(neighbours, curve[point].rhe_pct);
  if (!place || place->share == 0) return std::nullopt;
  return std::abs(place->gain - curve[point].gain);
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
    if (!(share > 0 && share < 1)) continue;  // a constant RHE gives infinity or NaN
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
    if (!all[r].place) continue;
    values[r] = point.gain - all[r].place->gain;
    all[r].interpolation_error = InterpolationErrorAt(curve, *all[r].place);
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
    const auto n = static_cast<std::int64_t>(situations);
    all[r].difference = FromReplicates(n, values[r], std::move(replicates[r]));
  }
  return all;
}

double InterpolationErrorAt(std::span<const CurvePoint> curve, const CurvePlace& place) {
  if (place.share == 0) return 0;
  const std::size_t above = place.below + 1;
  const double stretch = std::abs(curve[above].rhe_pct - curve[place.below].rhe_pct);
  std::optional<double> largest;
  const auto widen = [&](std::size_t point, std::size_t outer) {
    const std::optional<double> off = OffTheOthers(curve, point);
    if (!off) return;
    const double beside = std::abs(curve[outer].rhe_pct - curve[point].rhe_pct);
    largest =
        std::max(largest.value_or(0), *off * std::max(1.0, (beside + stretch) / (2 * beside)));
  };
  widen(place.below, place.below - 1);
  widen(above, above + 1);
  const double whole = std::abs(curve[place.below + 1].gain - curve[place.below].gain);
  return 4 * place.share * (1 - place.share) * largest.value_or(whole);
}

Verdict AtEqualEngagement::verdict() const {
  Estimate widened = difference;
  widened.low -= interpolation_error;
  widened.high += interpolation_error;
  return VerdictOf(widened);
}

}  // namespace fogline::study
