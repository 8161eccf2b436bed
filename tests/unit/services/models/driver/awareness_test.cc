#include "services/models/driver/awareness.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(AwarenessTest, IsRecoveredFiveSecondsAfterItWasHalf) {
  models::Awareness awareness({}, 0.5);
  for (int i = 0; i < 49; ++i) awareness.Step(models::DriverTask::kDrives, 0.1);
  EXPECT_LT(awareness.awareness(), 1);
  awareness.Step(models::DriverTask::kDrives, 0.1 + 1e-9);
  EXPECT_EQ(awareness.awareness(), 1);
  EXPECT_EQ(awareness.Step(models::DriverTask::kDrives, 1), 1);
}

TEST(AwarenessTest, FadesTowardsMonitoringWithItsTimeConstant) {
  models::Awareness coarse({}, 1.0);
  coarse.Step(models::DriverTask::kMonitors, 60);
  EXPECT_NEAR(coarse.awareness(), 0.5 + 0.5 * std::exp(-1), 1e-12);
  models::Awareness fine({}, 1.0);
  for (int i = 0; i < 600; ++i) fine.Step(models::DriverTask::kMonitors, 0.1);
  EXPECT_NEAR(fine.awareness(), coarse.awareness(), 1e-12);
}

TEST(AwarenessTest, MakesErrorsAndReactionTimesOfWhatIsMissing) {
  const models::Awareness aware({}, 1.0);
  EXPECT_EQ(aware.ReactionTime_s(), 0.8);
  EXPECT_EQ(aware.GapError(), 0);
  EXPECT_EQ(aware.ApproachError_ps(), 0);
  const models::Awareness half({}, 0.5);
  EXPECT_NEAR(half.ReactionTime_s(), 1.15, 1e-12);
  EXPECT_NEAR(half.GapError(), 0.075, 1e-12);          // 0.75 * 0.2 * missing awareness 0.5
  EXPECT_NEAR(half.ApproachError_ps(), 0.015, 1e-12);  // 0.15 * 0.2 * missing awareness 0.5
}

TEST(AwarenessTest, RefusesATimeConstantOfNothing) {
  AwarenessParameters p;
  p.fading_s = 0;
  EXPECT_THROW(models::Awareness{p}, std::invalid_argument);
}

}  // namespace
}  // namespace fogline
