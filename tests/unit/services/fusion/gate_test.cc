#include "services/fusion/gate.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr double kInside = 1.0;
constexpr double kOutside = 100.0;

TEST(GateTest, LimitIsTheChiSquareQuantileOfOneDegreeOfFreedom) {
  // Printed tables of the chi-square distribution have 3.841 for 5 %, and 10.828 for 0.1 %. The
  // tolerance is half a unit of the last printed digit.
  EXPECT_NEAR(fusion::Gate(0.95, 5).limit(), 3.841, 5e-4);
  EXPECT_NEAR(fusion::Gate(0.999, 5).limit(), 10.828, 5e-4);
}

TEST(GateTest, LimitItselfIsInside) {
  fusion::Gate gate(0.95, 5);
  EXPECT_TRUE(gate.Admits(gate.limit()));
  EXPECT_FALSE(gate.Admits(gate.limit() * (1 + 1e-12)));
}

TEST(GateTest, OpensAfterThatManyRefusalsInARow) {
  fusion::Gate gate(0.95, 3);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(gate.Admits(kOutside)) << i;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(gate.Admits(kOutside)) << i;
}

TEST(GateTest, ClosesAgainAtTheFirstValueInside) {
  fusion::Gate gate(0.95, 3);
  for (int i = 0; i < 3; ++i) gate.Admits(kOutside);
  EXPECT_TRUE(gate.Admits(kOutside));
  EXPECT_TRUE(gate.Admits(kInside));
  EXPECT_FALSE(gate.Admits(kOutside));
}

TEST(GateTest, StaysShutWhileOutliersComeOneByOne) {
  fusion::Gate gate(0.95, 2);
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(gate.Admits(kOutside)) << i;
    EXPECT_TRUE(gate.Admits(kInside)) << i;
  }
}

TEST(GateTest, NeverOpensIfItIsToldSo) {
  fusion::Gate gate(0.95, 0);
  for (int i = 0; i < 5000; ++i) ASSERT_FALSE(gate.Admits(kOutside)) << i;
  EXPECT_TRUE(gate.Admits(kInside)) << "a value inside is used as ever";
  EXPECT_FALSE(gate.Admits(kOutside));
}

}  // namespace
}  // namespace fogline
