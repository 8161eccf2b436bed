#include "tools/stats/mcnemar.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

namespace fogline {
namespace {

/// Values of which the first `yes` are 1.
std::vector<double> FirstYes(std::size_t yes) {
  std::vector<double> values(30, 0.0);
  for (std::size_t i = 0; i < yes; ++i) values[i] = 1;
  return values;
}

// By hand: six pairs differ, all in the same direction, so p is 2 * 0.5^6.
TEST(McNemarTest, CountsOnlyThePairsThatDiffer) {
  EXPECT_DOUBLE_EQ(stats::McNemar(FirstYes(6), FirstYes(0)), 0.03125);
  EXPECT_DOUBLE_EQ(stats::McNemar(FirstYes(0), FirstYes(6)), 0.03125);
  EXPECT_DOUBLE_EQ(stats::McNemar(FirstYes(16), FirstYes(10)), 0.03125) << "ten pairs are alike";
}

// By hand: five pairs differ, one of them in the other direction, so p is 2 * (1 + 5)/32.
TEST(McNemarTest, WeighsBothDirections) {
  EXPECT_DOUBLE_EQ(
      stats::McNemar(std::array{1.0, 1.0, 1.0, 1.0, 0.0}, std::array{0.0, 0.0, 0.0, 0.0, 1.0}),
      0.375);
  EXPECT_EQ(stats::McNemar(std::array{1.0, 0.0}, std::array{0.0, 1.0}), 1);
}

TEST(McNemarTest, IsOneWithoutADifference) {
  EXPECT_EQ(stats::McNemar(FirstYes(7), FirstYes(7)), 1);
  EXPECT_EQ(stats::McNemar({}, {}), 1);
}

}  // namespace
}  // namespace fogline
