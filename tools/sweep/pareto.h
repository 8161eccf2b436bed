// Which thresholds are worth considering: safety improvement against redundant human engagement.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace fogline {

/// What a threshold gives (SI, the more the better) and what it costs (RHE, the less the better).
struct TradeOff {
  double rhe_pct = 0;
  double si_pct = 0;
};

/// Places of the points that no other dominates, in order of ascending RHE, equal points in the
/// order in which they are given. A point dominates another if it is no worse in both quantities
/// and better in one; so equal points are all on the front. A point with NaN is not, and dominates
/// none.
std::vector<std::size_t> ParetoFront(std::span<const TradeOff> points);

}  // namespace fogline
