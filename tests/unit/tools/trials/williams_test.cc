#include "tools/trials/williams.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fogline::trials {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

TEST(WilliamsDesignTest, OneConditionHasOneOrder) {
  EXPECT_THAT(WilliamsDesign(1), ElementsAre(ElementsAre(0)));
}

TEST(WilliamsDesignTest, TwoConditionsHaveBothOrders) {
  EXPECT_THAT(WilliamsDesign(2), ElementsAre(ElementsAre(0, 1), ElementsAre(1, 0)));
}

TEST(WilliamsDesignTest, ThreeConditionsHaveAllSixOrdersInTwoLatinSquares) {
  EXPECT_THAT(WilliamsDesign(3),
              ElementsAre(ElementsAre(0, 1, 2), ElementsAre(1, 2, 0), ElementsAre(2, 0, 1),
                          ElementsAre(2, 1, 0), ElementsAre(0, 2, 1), ElementsAre(1, 0, 2)));
}

TEST(WilliamsDesignTest, FourConditionsHaveTheFirstOrderOfTheLiterature) {
  // For four treatments, Williams 1949 gives the order 1 2 4 3. Each further order adds 1 modulo 4.
  // The numbers here begin with 0.
  const auto orders = WilliamsDesign(4);
  ASSERT_THAT(orders, SizeIs(4));
  EXPECT_THAT(orders[0], ElementsAre(0, 1, 3, 2));
  EXPECT_THAT(orders[1], ElementsAre(1, 2, 0, 3));
}

}  // namespace
}  // namespace fogline::trials
