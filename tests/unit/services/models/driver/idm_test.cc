#include "services/models/driver/idm.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/services/models/driver/examples.h"

namespace fogline {
namespace {

constexpr double kFreeRoad_m = 1e9;

TEST(IdmTest, BrakesAsWorkedByHand) {
  // With the default parameters a = 0.73, b = 1.67, v_0 = 33.33, T = 1.5 and s_0 = 2 (idm.h), the
  // desired gap is s* = 32 + 40 / (2 sqrt(1.2191)) = 50.1137 m, and the acceleration is 0.73 (1 -
  // 0.12965 - 1.56961). The tolerance is half a unit of the last digit.
  EXPECT_NEAR(models::Idm(DriverSection()).Acceleration(20, 18, 40), -0.5105, 5e-5);
}

TEST(IdmTest, StartsOnAFreeRoadAtMaximumAcceleration) {
  const DriverSection driver;
  EXPECT_NEAR(models::Idm(driver).Acceleration(0, 0, kFreeRoad_m), driver.max_acceleration_mps2,
              kNear);
}

TEST(IdmTest, HoldsTheDesiredSpeedOnAFreeRoad) {
  const DriverSection driver;
  const double v0 = driver.desired_speed_mps;
  EXPECT_NEAR(models::Idm(driver).Acceleration(v0, v0, kFreeRoad_m), 0, kNear);
  EXPECT_GT(models::Idm(driver).Acceleration(0.99 * v0, v0, kFreeRoad_m), 0);
  EXPECT_LT(models::Idm(driver).Acceleration(1.01 * v0, v0, kFreeRoad_m), 0);
}

TEST(IdmTest, StandsStillAtTheStandstillGap) {
  const DriverSection driver;
  const models::Idm idm(driver);
  EXPECT_EQ(idm.Acceleration(0, 0, driver.standstill_m), 0);
  EXPECT_GT(idm.Acceleration(0, 0, 1.1 * driver.standstill_m), 0);
  EXPECT_LT(idm.Acceleration(0, 0, 0.9 * driver.standstill_m), 0);
}

TEST(IdmTest, WantsNoLessThanTheStandstillGapBehindACarThatRunsAway) {
  const DriverSection driver;
  const models::Idm idm(driver);
  const double away = 1000;  // m/s: s* is the standstill gap at this speed, and at twice this speed
  EXPECT_EQ(idm.Acceleration(10, away, 5), idm.Acceleration(10, 2 * away, 5));
}

TEST(IdmTest, BrakesAsHardAsItCanWhereTheFormulaHasNoLimit) {
  DriverSection driver;
  driver.max_deceleration_mps2 = 7;
  const models::Idm idm(driver);
  EXPECT_EQ(idm.Acceleration(20, 20, 0), -7);
  EXPECT_EQ(idm.Acceleration(20, 20, -3), -7);
  EXPECT_EQ(idm.Acceleration(20, 20, std::numeric_limits<double>::denorm_min()), -7);
  EXPECT_EQ(idm.Acceleration(60, 0, 1), -7);
}

TEST(IdmTest, TakesANegativeSpeedForStandingStill) {
  DriverSection driver;
  driver.exponent = 3.5;  // a negative number has no power with this exponent
  const models::Idm idm(driver);
  EXPECT_EQ(idm.Acceleration(-0.1, 5, 20), idm.Acceleration(0, 5, 20));
}

}  // namespace
}  // namespace fogline
