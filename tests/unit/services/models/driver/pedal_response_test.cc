#include "services/models/driver/pedal_response.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fogline {
namespace {

PersonSection Person(PedalMap map) {
  PersonSection person;
  person.pedal_map = map;
  person.pedal_exponent = 2;
  person.full_throttle_mps2 = 3;
  person.full_brake_mps2 = 8;
  person.coasting_mps2 = 0.5;
  return person;
}

TEST(PedalResponseTest, IsTheEquationOfItsHeader) {
  const models::PedalResponse linear(Person(PedalMap::kLinear));
  EXPECT_DOUBLE_EQ(linear.Acceleration(0.5, 0), 3 * 0.5 - 0.5 * 0.5);
  EXPECT_DOUBLE_EQ(linear.Acceleration(0, 0.25), -0.5 - 8 * 0.25);
  EXPECT_DOUBLE_EQ(linear.Acceleration(1, 0.25), 3 - 8 * 0.25);
  const models::PedalResponse progressive(Person(PedalMap::kProgressive));
  EXPECT_DOUBLE_EQ(progressive.Acceleration(0.5, 0), 3 * 0.25 - 0.5 * 0.75);
  EXPECT_DOUBLE_EQ(progressive.Acceleration(0, 0.5), -0.5 - 8 * 0.25);
}

TEST(PedalResponseTest, GivesTheFullValuesAtTheEndsWithEitherMap) {
  for (const PedalMap map : {PedalMap::kLinear, PedalMap::kProgressive}) {
    const models::PedalResponse pedals(Person(map));
    EXPECT_EQ(pedals.Acceleration(0, 0), -0.5);
    EXPECT_EQ(pedals.Acceleration(1, 0), 3);
    EXPECT_EQ(pedals.Acceleration(0, 1), -8) << "coasting does not add to the full brake";
    EXPECT_EQ(pedals.Acceleration(7, 0), 3);
    EXPECT_EQ(pedals.Acceleration(-7, 0), -0.5);
  }
}

TEST(PedalResponseTest, GrowsWithTheThrottleAndFallsWithTheBrake) {
  const models::PedalResponse pedals(Person(PedalMap::kProgressive));
  for (int i = 0; i < 100; ++i) {
    EXPECT_LT(pedals.Acceleration(i / 100.0, 0), pedals.Acceleration((i + 1) / 100.0, 0));
    EXPECT_GE(pedals.Acceleration(0, i / 100.0), pedals.Acceleration(0, (i + 1) / 100.0));
  }
}

TEST(PedalResponseTest, TakesOverFromTheThresholdOnWithEitherPedal) {
  PersonSection person;
  person.take_over_pedal = 0.2;
  const models::PedalResponse pedals(person);
  EXPECT_FALSE(pedals.TakesOver(0.19, 0.19));
  EXPECT_TRUE(pedals.TakesOver(0.2, 0));
  EXPECT_TRUE(pedals.TakesOver(0, 0.2));
}

}  // namespace
}  // namespace fogline
