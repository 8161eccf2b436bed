#include "services/models/vehicle/motion.h"

#include <limits>

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(MotionTest, AdvancesByTheClosedForm) {
  const models::Motion to = models::Advance({100.0, 20.0}, 2.0, 0.5);
  EXPECT_DOUBLE_EQ(to.position_m, 110.25);
  EXPECT_DOUBLE_EQ(to.speed_mps, 21.0);
}

TEST(MotionTest, ComesToRestAtTheExactMomentWithinTheStep) {
  // From 0.5 m/s at -10 m/s2, the car is at rest after 0.05 s and v^2 / (2 a) = 0.0125 m.
  const models::Motion to = models::Advance({3.0, 0.5}, -10.0, 0.1);
  EXPECT_DOUBLE_EQ(to.position_m, 3.0125);
  EXPECT_EQ(to.speed_mps, 0.0);
}

TEST(MotionTest, DoesNotRollBackFromRest) {
  const models::Motion to = models::Advance({3.0, 0.0}, -10.0, 0.1);
  EXPECT_EQ(to.position_m, 3.0);
  EXPECT_EQ(to.speed_mps, 0.0);
}

TEST(MotionTest, StartsFromRest) {
  const models::Motion to = models::Advance({0.0, 0.0}, 2.0, 1.0);
  EXPECT_DOUBLE_EQ(to.position_m, 1.0);
  EXPECT_DOUBLE_EQ(to.speed_mps, 2.0);
}

TEST(MotionTest, NeverRestsWithoutBraking) {
  EXPECT_EQ(models::TimeToRest(20.0, 0.0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(models::TimeToRest(0.0, 1.0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(models::TimeToRest(0.0, -1.0), 0.0);
  EXPECT_DOUBLE_EQ(models::TimeToRest(20.0, -4.0), 5.0);
}

TEST(ContactTest, OfConstantSpeedsIsGapOverClosingSpeed) {
  EXPECT_DOUBLE_EQ(models::TimeToContact(10.0, 15.0, 0.0, 20.0, 0.0, 3.0).value(), 2.0);
}

TEST(ContactTest, IsTheFirstRootOfTheParabola) {
  // The gap is 6 - 5 t + t^2 = (t - 2) (t - 3). The cars touch at 2 s. Without the contact, they
  // would separate at 3 s.
  EXPECT_DOUBLE_EQ(models::TimeToContact(6.0, 20.0, 2.0, 25.0, 0.0, 10.0).value(), 2.0);
}

TEST(ContactTest, HappensWhenTheGapOpensFirst) {
  // The gap is 8 + 2 t - 3 t^2 = (2 - t) (4 + 3 t), so the cars touch at 2 s.
  EXPECT_DOUBLE_EQ(models::TimeToContact(8.0, 30.0, -6.0, 28.0, 0.0, 4.0).value(), 2.0);
}

TEST(ContactTest, CountsAtTheEndItself) {
  EXPECT_DOUBLE_EQ(models::TimeToContact(10.0, 15.0, 0.0, 20.0, 0.0, 2.0).value(), 2.0);
}

TEST(ContactTest, DoesNotHappenAfterTheEnd) {
  EXPECT_FALSE(models::TimeToContact(10.0, 15.0, 0.0, 20.0, 0.0, 1.999));
  EXPECT_FALSE(models::TimeToContact(10.0, 20.0, 0.0, 20.0, 0.0, 1e6));
  EXPECT_FALSE(models::TimeToContact(10.0, 25.0, 0.0, 20.0, 0.0, 1e6));
}

TEST(ContactTest, CountsTheRestOfTheCarAhead) {
  // The car ahead stops after 1 s and 5 m. The car behind keeps 10 m/s, so the cars touch after
  // (7 + 5) m / 10 m/s. If the car ahead rolled back instead, the gap 7 - 5 t^2 would close at
  // 1.183 s.
  EXPECT_DOUBLE_EQ(models::TimeToContact(7.0, 10.0, -10.0, 10.0, 0.0, 2.0).value(), 1.2);
}

TEST(ContactTest, DoesNotHappenIfTheCarBehindStopsInFrontOfTheGap) {
  // The car behind needs 4^2 / (2 * 2) = 4 m to stop; the car ahead stands still.
  EXPECT_FALSE(models::TimeToContact(4.001, 0.0, 0.0, 4.0, -2.0, 10.0));
  EXPECT_DOUBLE_EQ(models::TimeToContact(3.0, 0.0, 0.0, 4.0, -2.0, 10.0).value(), 1.0);
}

TEST(ContactTest, CountsATouchAtTheMomentOfRest) {
  EXPECT_DOUBLE_EQ(models::TimeToContact(4.0, 0.0, 0.0, 4.0, -2.0, 10.0).value(), 2.0);
}

TEST(ContactTest, IsImmediateIfTheGapIsClosed) {
  EXPECT_EQ(models::TimeToContact(0.0, 20.0, 0.0, 10.0, 0.0, 1.0).value(), 0.0);
  EXPECT_EQ(models::TimeToContact(-0.5, 20.0, 0.0, 10.0, 0.0, 1.0).value(), 0.0);
}

}  // namespace
}  // namespace fogline
