// Selects the thresholds on the Pareto front of safety improvement and redundant human engagement.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace fogline::stats {

/// Benefit of a threshold (SI, more is better) and its cost (RHE, less is better).
struct TradeOff {
  double rhe_pct = 0;
  double si_pct = 0;
};

/// Indices of the points that no other point dominates, in order of ascending RHE. Equal points
/// keep the given order. A point dominates another point if it is better in one quantity and equal
/// or better in the other quantity. So of several equal points, all or none are on the front. A
/// point with NaN is not on the front and dominates no point.
std::vector<std::size_t> ParetoFront(std::span<const TradeOff> points);

}  // namespace fogline::stats
