#include "services/models/minimal_risk/minimal_risk.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr double kStep_s = 0.1;
constexpr MinimalRiskSection kLimits{.deceleration_mps2 = 3, .jerk_mps3 = 2};

TEST(MinimalRiskTest, BuildsTheBrakeUpAtTheJerkLimitAndHoldsIt) {
  models::MinimalRisk manoeuvre(kLimits, kStep_s);
  manoeuvre.Begin(0.5);
  double expected = 0.5;
  for (int k = 0; k < 30; ++k) {
    expected = std::max(-3.0, expected - 2 * kStep_s);
    EXPECT_NEAR(manoeuvre.Step(30), expected, 1e-12) << k;
  }
}

// r(v) of minimal_risk.h is the braking that can still be released until the car stands. With the
// jerk limit j and the time step h, r(v) is 1 m/s2 at v = r^2/(2 j) + r h/2 = 0.3 m/s. So the brake
// is released in exactly 5 time steps, by j h = 0.2 m/s2 in each step.
TEST(MinimalRiskTest, ReleasesTheBrakeStepByStepSoThatTheCarRestsWithoutIt) {
  models::MinimalRisk manoeuvre(kLimits, kStep_s);
  manoeuvre.Begin(-1.0);
  double speed_mps = 0.3;
  for (const double expected : {-1.0, -0.8, -0.6, -0.4, -0.2}) {
    const double command = manoeuvre.Step(speed_mps);
    EXPECT_NEAR(command, expected, 1e-12);
    speed_mps += command * kStep_s;
  }
  EXPECT_NEAR(speed_mps, 0, 1e-12);
}

TEST(MinimalRiskTest, ReleasesABrakeThatIsHarderThanItsLimitGently) {
  models::MinimalRisk manoeuvre(kLimits, kStep_s);
  manoeuvre.Begin(-9);
  EXPECT_NEAR(manoeuvre.Step(30), -8.8, 1e-12);
  for (int k = 0; k < 100; ++k) manoeuvre.Step(30);
  EXPECT_NEAR(manoeuvre.Step(30), -3, 1e-12);
}

TEST(MinimalRiskTest, BeginsOnce) {
  models::MinimalRisk manoeuvre(kLimits, kStep_s);
  EXPECT_FALSE(manoeuvre.begun());
  manoeuvre.Begin(0);
  manoeuvre.Step(30);
  manoeuvre.Begin(5);
  EXPECT_TRUE(manoeuvre.begun());
  EXPECT_NEAR(manoeuvre.Step(30), -0.4, 1e-12);
}

TEST(MinimalRiskTest, HoldsACarThatStands) {
  models::MinimalRisk manoeuvre(kLimits, kStep_s);
  manoeuvre.Begin(0);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(manoeuvre.Step(0), 0);
}

TEST(MinimalRiskTest, TakesTheThrottleAwayAtTheJerkLimitFromACarThatStands) {
  models::MinimalRisk manoeuvre(kLimits, kStep_s);
  manoeuvre.Begin(0.7);
  for (const double expected : {0.5, 0.3, 0.1, 0.0, 0.0}) {
    EXPECT_NEAR(manoeuvre.Step(0), expected, 1e-12);
  }
}

TEST(MinimalRiskTest, BrakesACarThatRollsAgain) {
  models::MinimalRisk manoeuvre(kLimits, kStep_s);
  manoeuvre.Begin(0);
  manoeuvre.Step(0);
  EXPECT_LT(manoeuvre.Step(1), 0);
}

}  // namespace
}  // namespace fogline
