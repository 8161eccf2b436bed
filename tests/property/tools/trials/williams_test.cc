// The properties that define a Williams design, for every number of conditions that a file may
// have.
#include "tools/trials/williams.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <utility>

namespace fogline::trials {
namespace {

// An experiment has at most this many conditions (scenario/sections/plans/experiment.h).
constexpr std::size_t kMostConditions = 20;

TEST(WilliamsDesignProperty, EachOrderHasEachConditionOnce) {
  for (std::size_t n = 1; n <= kMostConditions; ++n) {
    for (const auto& order : WilliamsDesign(n)) {
      EXPECT_EQ(order.size(), n);
      EXPECT_EQ(std::set(order.begin(), order.end()).size(), n);
      EXPECT_LT(*std::set(order.begin(), order.end()).rbegin(), n);
    }
  }
}

TEST(WilliamsDesignProperty, EachSquareHasEachConditionOnceAtEachPlace) {
  for (std::size_t n = 1; n <= kMostConditions; ++n) {
    const auto orders = WilliamsDesign(n);
    ASSERT_EQ(orders.size(), n % 2 == 0 || n == 1 ? n : 2 * n);
    for (std::size_t square = 0; square < orders.size(); square += n) {
      for (std::size_t place = 0; place < n; ++place) {
        std::set<std::size_t> there;
        for (std::size_t row = 0; row < n; ++row) there.insert(orders[square + row][place]);
        EXPECT_EQ(there.size(), n) << n << " conditions, place " << place;
      }
    }
  }
}

TEST(WilliamsDesignProperty, EachPairOfNeighboursAppearsEquallyOften) {
  for (std::size_t n = 2; n <= kMostConditions; ++n) {
    std::map<std::pair<std::size_t, std::size_t>, int> pairs;
    for (const auto& order : WilliamsDesign(n)) {
      for (std::size_t i = 1; i < n; ++i) ++pairs[{order[i - 1], order[i]}];
    }
    EXPECT_EQ(pairs.size(), n * (n - 1));
    for (const auto& [pair, count] : pairs) {
      EXPECT_EQ(count, n % 2 == 0 ? 1 : 2) << n << ": " << pair.first << ", " << pair.second;
    }
  }
}

}  // namespace
}  // namespace fogline::trials
