#include "tools/stats/pareto.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fogline::stats {

std::vector<std::size_t> ParetoFront(std::span<const TradeOff> points) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isnan(points[i].rhe_pct) && !std::isnan(points[i].si_pct)) order.push_back(i);
  }
  const auto cheapest_first = [&](std::size_t i) {
    return std::tuple(points[i].rhe_pct, -points[i].si_pct, i);
  };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return cheapest_first(a) < cheapest_first(b); });
  // Every point that could dominate a point comes before it in this order. So it is enough to
  // compare each point with the last point on the front.
  std::vector<std::size_t> front;
  for (const std::size_t i : order) {
    if (!front.empty()) {
      const TradeOff& last = points[front.back()];
      const bool same = points[i].rhe_pct == last.rhe_pct && points[i].si_pct == last.si_pct;
      if (!same && points[i].si_pct <= last.si_pct) continue;
    }
    front.push_back(i);
  }
  return front;
}

}  // namespace fogline::stats
