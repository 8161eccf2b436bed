#include "services/world/world.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/unit/services/world/commands.h"

namespace fogline {
namespace {

TEST(WorldTest, StartsAsTheScenarioSays) {
  Scenario scenario;
  scenario.world.host_gap_m = 30.0;
  scenario.world.follower_gap_m = 25.0;
  scenario.world.vehicle_length_m = 5.0;
  scenario.lead.speed_mps = 21.0;
  scenario.world.host_speed_mps = 20.0;
  scenario.world.follower_speed_mps = 19.0;
  world::World world(scenario);
  const auto& [truth, ego] = world.Start(77);
  EXPECT_EQ(truth.header.run_id, 77);
  EXPECT_EQ(truth.header.step, 0);
  EXPECT_EQ(truth.header.utime, 0);
  EXPECT_DOUBLE_EQ(truth.preceding_position_m, 35.0);
  EXPECT_DOUBLE_EQ(truth.host_position_m, 0.0);
  EXPECT_DOUBLE_EQ(truth.host_gap_m, 30.0);
  ASSERT_EQ(truth.num_followers, 1);
  EXPECT_DOUBLE_EQ(truth.follower_position_m[0], -30.0);
  EXPECT_DOUBLE_EQ(truth.follower_gap_m[0], 25.0);
  EXPECT_EQ(truth.preceding_speed_mps, 21.0);
  EXPECT_EQ(truth.host_speed_mps, 20.0);
  EXPECT_EQ(truth.follower_speed_mps[0], 19.0);
  EXPECT_EQ(truth.host_acceleration_mps2, 0.0);
  EXPECT_EQ(truth.collision, truth_t::COLLISION_NONE);
  EXPECT_FALSE(truth.last);
  EXPECT_EQ(ego.header.run_id, 77);
  EXPECT_EQ(ego.speed_mps, 20.0);
}

TEST(WorldTest, MovesEachCarByItsOwnCommand) {
  world::World world{Scenario{}};
  world.Start(1);
  const auto& [truth, ego] = world.Step(HostCommand(2.0), FollowerCommand(-1.0));
  EXPECT_EQ(truth.header.step, 1);
  EXPECT_EQ(truth.header.utime, 100'000);
  EXPECT_DOUBLE_EQ(truth.preceding_position_m, 37.5 + 2.0);
  EXPECT_DOUBLE_EQ(truth.host_position_m, 2.01);
  EXPECT_DOUBLE_EQ(truth.host_speed_mps, 20.2);
  EXPECT_EQ(truth.host_acceleration_mps2, 2.0);
  EXPECT_DOUBLE_EQ(truth.follower_position_m[0], -37.5 + 1.995);
  EXPECT_DOUBLE_EQ(truth.follower_speed_mps[0], 19.9);
  EXPECT_EQ(truth.follower_acceleration_mps2[0], -1.0);
  EXPECT_DOUBLE_EQ(truth.host_gap_m, 33.0 - 0.01);
  EXPECT_DOUBLE_EQ(truth.follower_gap_m[0], 33.0 + 0.015);
  EXPECT_EQ(ego.header.step, 1);
  EXPECT_EQ(ego.speed_mps, truth.host_speed_mps);
  EXPECT_EQ(ego.acceleration_mps2, 2.0);
}

TEST(WorldTest, ReportsTheMeanAccelerationOfACarThatCameToRest) {
  // GIVEN: a host at 0.5 m/s that brakes with 10 m/s2 and is at rest after half of the step
  Scenario scenario;
  scenario.world.host_speed_mps = 0.5;
  world::World world(scenario);
  world.Start(1);
  // WHEN: the host comes to rest and still brakes
  const truth_t resting = Truth(world.Step(HostCommand(-10.0), FollowerCommand(0.0)));
  const truth_t at_rest = Truth(world.Step(HostCommand(-10.0), FollowerCommand(0.0)));
  // THEN: the acceleration of the host is the change of its speed, not the command
  EXPECT_EQ(resting.host_speed_mps, 0.0);
  EXPECT_DOUBLE_EQ(resting.host_acceleration_mps2, -5.0);
  EXPECT_DOUBLE_EQ(resting.host_position_m, 0.0125);
  EXPECT_EQ(at_rest.host_acceleration_mps2, 0.0);
  EXPECT_EQ(at_rest.host_position_m, resting.host_position_m);
}

TEST(WorldTest, TheLeaderFollowsItsProfileExactly) {
  Scenario scenario;
  scenario.lead.profile = LeadProfile::kEmergencyBrake;
  scenario.lead.emergency_brake = {.start_s = 1.05, .deceleration_mps2 = 6.0};
  world::World world(scenario);
  const world::Leader profile(scenario.lead);
  truth_t before = Truth(world.Start(1));
  for (int step = 1; step < 100; ++step) {
    const truth_t& truth = Truth(world.Step(HostCommand(-8.0), FollowerCommand(-8.0)));
    const double time_s = static_cast<double>(truth.header.utime) / 1e6;
    EXPECT_EQ(truth.preceding_speed_mps, profile.SpeedAt(step, time_s));
    EXPECT_DOUBLE_EQ(truth.preceding_acceleration_mps2,
                     (truth.preceding_speed_mps - before.preceding_speed_mps) / 0.1);
    // The acceleration is constant within the step, so the mean speed is the mean of the speeds at
    // both ends.
    EXPECT_NEAR(truth.preceding_position_m - before.preceding_position_m,
                0.05 * (truth.preceding_speed_mps + before.preceding_speed_mps), 1e-12);
    before = truth;
  }
  EXPECT_EQ(before.preceding_speed_mps, 0.0);
}

TEST(WorldTest, EndsOnTheLastStepOfTheScenario) {
  Scenario scenario;
  scenario.steps = 3;
  world::World world(scenario);
  EXPECT_FALSE(Truth(world.Start(1)).last);
  EXPECT_FALSE(Truth(world.Step(HostCommand(0.0), FollowerCommand(0.0))).last);
  EXPECT_TRUE(Truth(world.Step(HostCommand(0.0), FollowerCommand(0.0))).last);
}

TEST(WorldTest, ARunOfOneStepIsItsStart) {
  Scenario scenario;
  scenario.steps = 1;
  world::World world(scenario);
  EXPECT_TRUE(Truth(world.Start(1)).last);
}

// The host drives 2 m/s faster than the leader, 1.03 m behind it: contact after 0.515 s.
Scenario CollisionAhead() {
  Scenario scenario;
  scenario.lead.speed_mps = 18.0;
  scenario.world.host_gap_m = 1.03;
  scenario.world.host_speed_mps = 20.0;
  return scenario;
}

TEST(WorldTest, EndsOnTheStepOfTheFirstCollision) {
  world::World world(CollisionAhead());
  world.Start(1);
  for (int step = 1; step <= 5; ++step) {
    const truth_t& truth = Truth(world.Step(HostCommand(0.0), FollowerCommand(0.0)));
    EXPECT_EQ(truth.collision, truth_t::COLLISION_NONE);
    EXPECT_EQ(truth.collision_time_s, 0.0);
    EXPECT_FALSE(truth.last);
  }
  const truth_t& truth = Truth(world.Step(HostCommand(0.0), FollowerCommand(0.0)));
  EXPECT_EQ(truth.collision, truth_t::COLLISION_HOST);
  EXPECT_NEAR(truth.collision_time_s, 0.515, 1e-12);
  EXPECT_TRUE(truth.last);
}

TEST(WorldTest, KeepsTheFirstCollisionWhenTheRunGoesOn) {
  // GIVEN: a run that continues after collisions; the host hits the leader, then the follower hits
  // the host
  Scenario scenario = CollisionAhead();
  scenario.world.end_on_collision = false;
  scenario.world.follower_gap_m = 2.0;
  scenario.world.follower_speed_mps = 22.0;
  world::World world(scenario);
  world.Start(1);
  // WHEN: 20 steps pass
  truth_t truth;
  for (int step = 1; step <= 20; ++step) {
    truth = Truth(world.Step(HostCommand(0.0), FollowerCommand(0.0)));
    EXPECT_FALSE(truth.last);
  }
  // THEN: the first collision is reported, and the cars have passed through each other
  EXPECT_EQ(truth.collision, truth_t::COLLISION_HOST);
  EXPECT_NEAR(truth.collision_time_s, 0.515, 1e-12);
  EXPECT_NEAR(truth.host_gap_m, 1.03 - 4.0, 1e-12);
  EXPECT_NEAR(truth.follower_gap_m[0], 2.0 - 4.0, 1e-12);
}

TEST(WorldTest, OfTwoCollisionsInAStepRecordsTheEarlier) {
  Scenario scenario;
  scenario.step_s = 1.0;
  scenario.world.host_gap_m = 1.0;
  scenario.world.follower_gap_m = 1.0;
  scenario.lead.speed_mps = 18.0;
  scenario.world.host_speed_mps = 20.0;
  scenario.world.follower_speed_mps = 24.0;
  world::World world(scenario);
  world.Start(1);
  const truth_t& truth = Truth(world.Step(HostCommand(0.0), FollowerCommand(0.0)));
  EXPECT_EQ(truth.collision, truth_t::COLLISION_FOLLOWER);
  EXPECT_DOUBLE_EQ(truth.collision_time_s, 0.25);
}

TEST(WorldTest, StartBeginsAgainFromTheStart) {
  world::World world(CollisionAhead());
  const truth_t first = Truth(world.Start(1));
  for (int step = 1; step <= 6; ++step) world.Step(HostCommand(1.0), FollowerCommand(-1.0));
  const truth_t again = Truth(world.Start(1));
  EXPECT_EQ(again.header.step, 0);
  EXPECT_EQ(again.collision, truth_t::COLLISION_NONE);
  EXPECT_EQ(again.host_acceleration_mps2, 0.0);
  EXPECT_EQ(again.host_gap_m, first.host_gap_m);
  EXPECT_EQ(again.last, first.last);
}

TEST(WorldTest, ResumesWithTheTimeOfACollisionThatHasHappened) {
  Scenario scenario = CollisionAhead();
  scenario.world.end_on_collision = false;
  world::World before(scenario);
  before.Start(1);
  truth_t truth;
  for (int step = 1; step <= 8; ++step) {
    truth = Truth(before.Step(HostCommand(0.0), FollowerCommand(0.0)));
  }
  world::World after(scenario);
  after.Resume(truth);
  EXPECT_EQ(after.truth().collision, truth_t::COLLISION_HOST);
  EXPECT_EQ(after.truth().collision_time_s, truth.collision_time_s);
  const truth_t& next = Truth(after.Step(HostCommand(0.0), FollowerCommand(0.0)));
  EXPECT_EQ(next.collision_time_s, truth.collision_time_s);
}

TEST(WorldTest, CountsTimeInWholeMicroseconds) {
  Scenario scenario;
  scenario.step_s = 0.05;
  world::World world(scenario);
  world.Start(1);
  for (int step = 1; step <= 7; ++step) world.Step(HostCommand(0.0), FollowerCommand(0.0));
  EXPECT_EQ(Truth(world.Step(HostCommand(0.0), FollowerCommand(0.0))).header.utime, 400'000);
}

TEST(WorldTest, PutsTheFogOfItsTimeIntoTheTruth) {
  Scenario scenario;
  scenario.fog.model = FogModel::kBeam;
  scenario.fog.profile = FogProfile::kBox;
  scenario.fog.start_s = 0.1;
  scenario.fog.duration_s = 0.1;
  scenario.fog.visibility_m = 60.0;
  world::World world(scenario);
  EXPECT_FALSE(Truth(world.Start(1)).fog_present);
  const truth_t in_fog = Truth(world.Step(HostCommand(0.0), FollowerCommand(0.0)));
  EXPECT_TRUE(in_fog.fog_present);
  EXPECT_EQ(in_fog.fog_level, 1.0);
  EXPECT_DOUBLE_EQ(in_fog.fog_visibility_m, 60.0);
  const truth_t after = Truth(world.Step(HostCommand(0.0), FollowerCommand(0.0)));
  EXPECT_FALSE(after.fog_present);
  EXPECT_EQ(after.fog_visibility_m, 20000.0);
}

TEST(WorldTest, RefusesCommandsThatAreNoAccelerationPerCar) {
  world::World world{Scenario{}};
  world.Start(1);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(world.Step(HostCommand(kNan), FollowerCommand(0.0)), std::invalid_argument);
  EXPECT_THROW(world.Step(HostCommand(0.0), FollowerCommand(INFINITY)), std::invalid_argument);
  EXPECT_THROW(world.Step(HostCommand(0.0), follower_command_t{}), std::invalid_argument);
}

}  // namespace
}  // namespace fogline
