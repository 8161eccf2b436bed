#include "tools/stats/holm.h"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fogline {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

// The expected values are from R: p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm").
TEST(HolmTest, AdjustsForTheNumberOfTestsStepByStep) {
  constexpr double kSame = 1e-12;
  EXPECT_THAT(stats::Holm(std::array{0.01, 0.04, 0.03, 0.005}),
              ElementsAre(DoubleNear(0.03, kSame), DoubleNear(0.06, kSame), DoubleNear(0.06, kSame),
                          DoubleNear(0.02, kSame)));
}

TEST(HolmTest, HasNoProbabilityAboveOne) {
  EXPECT_THAT(stats::Holm(std::array{0.6, 0.9}), ElementsAre(1.0, 1.0));
  EXPECT_TRUE(stats::Holm({}).empty());
}

}  // namespace
}  // namespace fogline
