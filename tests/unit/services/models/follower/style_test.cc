#include "services/models/follower/style.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(StyleTest, KeepsMoreRoomTheMoreCautious) {
  const models::StyleParameters aggressive = models::ParametersOf(models::Style::kAggressive);
  const models::StyleParameters normal = models::ParametersOf(models::Style::kNormal);
  const models::StyleParameters cautious = models::ParametersOf(models::Style::kCautious);
  EXPECT_LT(aggressive.driver.headway_s, normal.driver.headway_s);
  EXPECT_LT(normal.driver.headway_s, cautious.driver.headway_s);
  EXPECT_GT(aggressive.driver.max_acceleration_mps2, normal.driver.max_acceleration_mps2);
  EXPECT_GT(normal.driver.max_acceleration_mps2, cautious.driver.max_acceleration_mps2);
  EXPECT_LT(aggressive.human.reaction_time_s, cautious.human.reaction_time_s);
}

TEST(StyleTest, DrawsOnlyWhatHasAShare) {
  const Random random(9, Stream::kStyle);
  for (std::int64_t i = 0; i < 100; ++i) {
    EXPECT_EQ(models::DrawStyle({1, 0, 0}, random, i), models::Style::kAggressive);
    EXPECT_EQ(models::DrawStyle({0, 2, 0}, random, i), models::Style::kNormal);
    EXPECT_EQ(models::DrawStyle({0, 0, 0.1}, random, i), models::Style::kCautious);
  }
}

TEST(StyleTest, DrawsTheSameCarTheSameStyle) {
  const Random random(9, Stream::kStyle);
  for (std::int64_t i = 0; i < 20; ++i) {
    EXPECT_EQ(models::DrawStyle({}, random, i),
              models::DrawStyle({}, Random(9, Stream::kStyle), i));
  }
}

TEST(StyleTest, DrawsInProportionToTheShares) {
  const Random random(10, Stream::kStyle);
  constexpr int kCars = 10'000;
  int aggressive = 0;
  int normal = 0;
  for (int i = 0; i < kCars; ++i) {
    const models::Style style =
        models::DrawStyle({.aggressive = 2, .normal = 5, .cautious = 3}, random, i);
    aggressive += style == models::Style::kAggressive ? 1 : 0;
    normal += style == models::Style::kNormal ? 1 : 0;
  }
  // The standard deviations sqrt(n p (1 - p)) are 40 and 50 cars. The tolerances are four standard
  // deviations.
  EXPECT_NEAR(aggressive, 2000, 160);
  EXPECT_NEAR(normal, 5000, 200);
}

TEST(StyleTest, RefusesNoShares) {
  const Random random(9, Stream::kStyle);
  EXPECT_THROW(models::DrawStyle({0, 0, 0}, random, 0), std::invalid_argument);
  EXPECT_THROW(models::DrawStyle({1, -1, 1}, random, 0), std::invalid_argument);
}

}  // namespace
}  // namespace fogline
