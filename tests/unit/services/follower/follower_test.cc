#include "services/follower/follower.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

truth_t Truth(double gap_m, double host_speed_mps, double speed_mps) {
  truth_t truth{};
  truth.header = {.run_id = 7, .step = 42, .utime = 4'200'000};
  truth.host_speed_mps = host_speed_mps;
  truth.num_followers = 1;
  truth.follower_position_m = {-gap_m - 4.5};
  truth.follower_speed_mps = {speed_mps};
  truth.follower_acceleration_mps2 = {0};
  truth.follower_gap_m = {gap_m};
  return truth;
}

TEST(FollowerTest, CopiesTheHeaderOfItsInput) {
  follower::Follower follower(Scenario{});
  const follower_command_t& command = follower.Step(Truth(33, 20, 20));
  EXPECT_EQ(command.header.run_id, 7);
  EXPECT_EQ(command.header.step, 42);
  EXPECT_EQ(command.header.utime, 4'200'000);
}

TEST(FollowerTest, HoldsTheSafeDistanceOfItsOwnSection) {
  Scenario scenario;
  scenario.follower.headway_s = 2;
  scenario.follower.standstill_m = 4;
  const follower_command_t command = follower::Follower(scenario).Step(Truth(44, 20, 20));
  ASSERT_EQ(command.num_followers, 1);
  ASSERT_EQ(command.acceleration_mps2.size(), 1U);
  ASSERT_EQ(command.safe_distance_m.size(), 1U);
  EXPECT_EQ(command.safe_distance_m[0], 44);
  EXPECT_EQ(command.acceleration_mps2[0], 0);
}

TEST(FollowerTest, BrakesWhenTheHostSlowsDown) {
  follower::Follower follower(Scenario{});
  EXPECT_LT(follower.Step(Truth(33, 18, 20)).acceleration_mps2[0], 0);
}

TEST(FollowerTest, ClosesUpWhenTheGapIsTooLarge) {
  follower::Follower follower(Scenario{});
  EXPECT_GT(follower.Step(Truth(40, 20, 20)).acceleration_mps2[0], 0);
}

TEST(FollowerTest, AnswersWithoutACommandWhenThereIsNoFollowingCar) {
  follower::Follower follower(Scenario{});
  const follower_command_t& command = follower.Step(truth_t{});
  EXPECT_EQ(command.num_followers, 0);
  EXPECT_TRUE(command.acceleration_mps2.empty());
  EXPECT_TRUE(command.safe_distance_m.empty());
}

TEST(FollowerTest, KeepsItsMessagesMemory) {
  follower::Follower follower(Scenario{});
  const follower_command_t& command = follower.Step(Truth(33, 20, 20));
  const double* const data = command.acceleration_mps2.data();
  for (int k = 0; k < 10; ++k) follower.Step(Truth(33, 20 - k, 20));
  EXPECT_EQ(command.acceleration_mps2.data(), data);
}

Scenario Braking(FollowerDriver driver) {
  Scenario scenario;
  scenario.followers.driver = driver;
  scenario.followers.aeb.enabled = true;
  return scenario;
}

TEST(FollowerTest, BrakesInAnEmergencyUnderEitherDriver) {
  for (const FollowerDriver driver : {FollowerDriver::kAcc, FollowerDriver::kHuman}) {
    follower::Follower follower(Braking(driver));
    EXPECT_GT(follower.Step(Truth(40, 20, 20)).acceleration_mps2[0], -9);
    EXPECT_LE(follower.Step(Truth(9, 10, 20)).acceleration_mps2[0], -9);
    EXPECT_GT(follower.Step(Truth(9, 20, 20)).acceleration_mps2[0], -9) << "and releases the brake";
  }
}

TEST(FollowerTest, DoesNotBrakeInAnEmergencyByDefault) {
  follower::Follower follower(Scenario{});
  EXPECT_GE(follower.Step(Truth(9, 10, 20)).acceleration_mps2[0], -3);
}

TEST(FollowerTest, BrakesForNoCarThatAPersonDoesNotSeeInFog) {
  Scenario scenario = Braking(FollowerDriver::kHuman);
  scenario.followers.sight = Sight::kFog;
  follower::Follower follower(scenario);
  truth_t truth = Truth(9, 10, 20);
  truth.fog_visibility_m = 0.5;
  EXPECT_GT(follower.Step(truth).acceleration_mps2[0], -9);
  truth.fog_visibility_m = 20'000;
  EXPECT_LE(follower.Step(truth).acceleration_mps2[0], -9);
}

TEST(FollowerTest, ForgetsAnEmergencyWhenItStartsAgain) {
  const Scenario scenario = Braking(FollowerDriver::kAcc);
  follower::Follower follower(scenario);
  follower.Step(Truth(9, 10, 20));
  follower.Restart(scenario);
  EXPECT_GT(follower.Step(Truth(60, 18, 20)).acceleration_mps2[0], -9) << "braking would go on";
  follower.Restart(Scenario{});
  EXPECT_GE(follower.Step(Truth(9, 10, 20)).acceleration_mps2[0], -3) << "the system is gone";
}

}  // namespace
}  // namespace fogline
