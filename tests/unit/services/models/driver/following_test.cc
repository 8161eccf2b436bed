#include "services/models/driver/following.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/unit/services/models/driver/examples.h"

namespace fogline {
namespace {

TEST(FollowingTest, IsTheDriversOwnIdm) {
  const DriverSection driver;
  const models::Following idm(FollowingModel::kIdm, driver);
  EXPECT_EQ(idm.Acceleration(Behind(20, 40, 18)), models::Idm(driver).Acceleration(20, 18, 40));
  EXPECT_EQ(idm.Acceleration({.speed_mps = 20}), models::Idm(driver).Acceleration(20, 20, 1e300));
}

TEST(FollowingTest, IidmKeepsExactlyStandstillGapAndHeadway) {
  const DriverSection driver;
  const models::Following iidm(FollowingModel::kIidm, driver);
  for (const double v : {0.0, 1.0, 10.0, 20.0, 33.0}) {
    const double gap_m = driver.standstill_m + v * driver.headway_s;
    EXPECT_EQ(iidm.Acceleration(Behind(v, gap_m, v)), 0) << v;
    EXPECT_GT(iidm.Acceleration(Behind(v, 1.01 * gap_m, v)), 0) << v;
    EXPECT_LT(iidm.Acceleration(Behind(v, 0.99 * gap_m, v)), 0) << v;
    // At this gap the IDM still brakes, because the IDM keeps a larger gap.
    const models::Following idm(FollowingModel::kIdm, driver);
    if (v > 0) {
      EXPECT_LT(idm.Acceleration(Behind(v, gap_m, v)), 0) << v;
    }
  }
}

TEST(FollowingTest, IidmIsAsWorkedByHand) {
  DriverSection driver;
  driver.max_acceleration_mps2 = 1;
  driver.comfortable_deceleration_mps2 = 2;
  driver.desired_speed_mps = 20;
  driver.headway_s = 1;
  driver.standstill_m = 2;
  driver.exponent = 4;
  const models::Following iidm(FollowingModel::kIidm, driver);
  // The desired gap s* is 12 m, so its ratio to the gap is z = 2, and the acceleration is 1 - z^2 =
  // -3.
  EXPECT_NEAR(iidm.Acceleration(Behind(10, 6, 10)), -3, kNear);
  // z = 1/2 and a_free = 1 - 1/16 = 15/16, so the acceleration is 15/16 (1 - 2^(-32/15)).
  EXPECT_NEAR(iidm.Acceleration(Behind(10, 24, 10)), 0.9375 * (1 - std::exp2(-32.0 / 15)), kNear);
  // Above the desired speed, the acceleration on a free road is -2 (1 - (1/2)^2) = -1.5. With s* =
  // 42 m at a gap of 21 m, z = 2, so the car brakes by 3 m/s2 more.
  EXPECT_NEAR(iidm.Acceleration({.speed_mps = 40}), -1.5, kNear);
  EXPECT_NEAR(iidm.Acceleration(Behind(40, 1000, 40)), -1.5, kNear);
  EXPECT_NEAR(iidm.Acceleration(Behind(40, 21, 40)), -4.5, kNear);
}

TEST(FollowingTest, AccIdmWithoutCoolnessIsTheIidm) {
  const DriverSection driver;
  const models::Following iidm(FollowingModel::kIidm, driver);
  const models::Following acc(FollowingModel::kAccIdm, driver, 0);
  for (const double gap_m : {1.0, 10.0, 30.0, 200.0}) {
    for (const double lead_mps : {0.0, 15.0, 25.0}) {
      const models::Situation seen = Behind(20, gap_m, lead_mps, -1);
      EXPECT_EQ(acc.Acceleration(seen), iidm.Acceleration(seen));
    }
  }
}

TEST(FollowingTest, AccIdmTakesACutInCoolly) {
  // GIVEN a car that cuts in at 6 m and is 2 m/s faster
  DriverSection driver;
  driver.max_acceleration_mps2 = 1;
  driver.comfortable_deceleration_mps2 = 2;
  const models::Situation cut_in = Behind(20, 6, 22);
  const double improved = models::Following(FollowingModel::kIidm, driver).Acceleration(cut_in);
  ASSERT_LT(improved, -5);
  // THEN the heuristic a_CAH (following.h) is 0, as for any steady faster car ahead, and the
  // comfortable deceleration limits the reaction
  for (const double c : {0.5, 0.99, 1.0}) {
    EXPECT_NEAR(models::Following(FollowingModel::kAccIdm, driver, c).Acceleration(cut_in),
                (1 - c) * improved + c * 2 * std::tanh(improved / 2), kNear);
  }
}

TEST(FollowingTest, AccIdmBrakesForACarThatWillStandAsItsHeuristicSays) {
  // The symbols are those of following.h: v = v_l = 20 m/s, s = 20 m and a~ = a_lead = -4 m/s2.
  // v_l (v - v_l) = 0 is below -2 s a~ = 160, so a_CAH = -1600 / 560 = -2.857. The IIDM with
  // s* = 32 m gives 0.73 (1 - 2.56) = -1.139. The model uses the IIDM, because -1.139 is larger
  // than -2.857.
  DriverSection driver;
  const models::Following acc(FollowingModel::kAccIdm, driver);
  EXPECT_NEAR(acc.Acceleration(Behind(20, 20, 20, -4)), 0.73 * (1 - 2.56), kNear);
  // With s = 8 m, z is 4, the IIDM is at its limit of -9 m/s2, and a_CAH = -1600 / 464 = -3.448.
  // The IIDM is below a_CAH. So the result is 1 % of the IIDM plus 99 % of the value `cool` (the
  // model has a coolness of 0.99).
  const double heuristic = -1600.0 / 464;
  const double b = driver.comfortable_deceleration_mps2;
  const double cool = heuristic + b * std::tanh((-9 - heuristic) / b);
  EXPECT_NEAR(acc.Acceleration(Behind(20, 8, 20, -4)), 0.01 * -9 + 0.99 * cool, kNear);
}

TEST(FollowingTest, StandsBehindACarThatStands) {
  for (const auto model : {FollowingModel::kIdm, FollowingModel::kIidm, FollowingModel::kAccIdm}) {
    const models::Following following(model, DriverSection{});
    EXPECT_EQ(following.Acceleration(Behind(0, 2, 0)), 0);
    EXPECT_EQ(following.Acceleration(Behind(20, 0, 20)), -9);
    EXPECT_EQ(following.Acceleration(Behind(20, -3, 20)), -9);
  }
}

TEST(FollowingTest, RefusesCoolnessThatIsNone) {
  EXPECT_THROW(models::Following(FollowingModel::kAccIdm, {}, 1.01), std::invalid_argument);
  EXPECT_THROW(models::Following(FollowingModel::kAccIdm, {}, -0.01), std::invalid_argument);
}

}  // namespace
}  // namespace fogline
