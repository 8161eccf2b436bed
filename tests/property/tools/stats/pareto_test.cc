#include "tools/stats/pareto.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "common/random.h"

namespace fogline {
namespace {

bool Dominates(const stats::TradeOff& a, const stats::TradeOff& b) {
  return a.rhe_pct <= b.rhe_pct && a.si_pct >= b.si_pct &&
         (a.rhe_pct < b.rhe_pct || a.si_pct > b.si_pct);
}

class ParetoFrontPropertyTest : public ::testing::TestWithParam<std::int64_t> {
 protected:
  /// Points with small whole numbers, so that many are equal in one or both values.
  static std::vector<stats::TradeOff> Points(std::int64_t seed) {
    const Random random(static_cast<std::uint64_t>(seed), Stream::kRadar);
    std::vector<stats::TradeOff> points;
    for (std::int64_t i = 0; i < 40; ++i) {
      const auto [rhe, si] = random.Normal2(i, 0);
      points.push_back({std::round(2 * rhe), std::round(2 * si)});
    }
    return points;
  }
};

TEST_P(ParetoFrontPropertyTest, HasExactlyThePointsThatNoOtherDominates) {
  const std::vector<stats::TradeOff> points = Points(GetParam());
  const std::vector<std::size_t> front = stats::ParetoFront(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool dominated =
        std::any_of(points.begin(), points.end(),
                    [&](const stats::TradeOff& other) { return Dominates(other, points[i]); });
    EXPECT_EQ(std::count(front.begin(), front.end(), i), dominated ? 0 : 1) << "point " << i;
  }
}

TEST_P(ParetoFrontPropertyTest, RisesInBothQuantities) {
  const std::vector<stats::TradeOff> points = Points(GetParam());
  const std::vector<std::size_t> front = stats::ParetoFront(points);
  for (std::size_t i = 1; i < front.size(); ++i) {
    EXPECT_LE(points[front[i - 1]].rhe_pct, points[front[i]].rhe_pct);
    EXPECT_LE(points[front[i - 1]].si_pct, points[front[i]].si_pct);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ParetoFrontPropertyTest, ::testing::Range<std::int64_t>(1, 21));

}  // namespace
}  // namespace fogline
