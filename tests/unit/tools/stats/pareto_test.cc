#include "tools/stats/pareto.h"

#include <limits>
#include <vector>

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

namespace fogline {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<std::size_t> FrontOf(const std::vector<stats::TradeOff>& points) {
  return stats::ParetoFront(points);
}

TEST(ParetoFrontTest, IsEmptyWithoutPoints) { EXPECT_THAT(FrontOf({}), IsEmpty()); }

TEST(ParetoFrontTest, HasThePublishedThresholdsButTheLast) {
  // The points are those of the paper's thresholds 0.2, 0.5 and 0.8. The third threshold gives less
  // safety than the second for the same engagement, so it is not on the front.
  EXPECT_THAT(FrontOf({{100, 100}, {0, 80.79}, {0, 10.23}}), ElementsAre(1, 0));
}

TEST(ParetoFrontTest, GoesFromTheLeastEngagementToTheMostSafety) {
  EXPECT_THAT(FrontOf({{50, 98}, {0, 80}, {3, 97}, {60, 97.5}, {100, 100}}),
              ElementsAre(1, 2, 0, 4));
}

TEST(ParetoFrontTest, DropsWhatIsEqualInOneAndWorseInTheOther) {
  EXPECT_THAT(FrontOf({{0, 80}, {1, 80}}), ElementsAre(0));
  EXPECT_THAT(FrontOf({{0, 79}, {0, 80}}), ElementsAre(1));
}

TEST(ParetoFrontTest, KeepsEqualPointsInTheirOrder) {
  EXPECT_THAT(FrontOf({{100, 100}, {0, 80}, {100, 100}, {0, 80}}), ElementsAre(1, 3, 0, 2));
}

TEST(ParetoFrontTest, LeavesOutPointsWithoutAValue) {
  EXPECT_THAT(FrontOf({{0, kNone}, {kNone, 100}, {5, 50}}), ElementsAre(2));
}

}  // namespace
}  // namespace fogline
