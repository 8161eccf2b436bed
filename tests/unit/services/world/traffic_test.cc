// The world with several following cars, and with cars of the vehicle model `longitudinal`.
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "services/runtime/wire/wire.h"
#include "services/world/world.h"
#include "tests/support/input_errors.h"
#include "tests/unit/services/world/commands.h"

namespace fogline {
namespace {

Scenario WithFollowers(std::int64_t count) {
  Scenario scenario;
  scenario.followers.count = count;
  return scenario;
}

Scenario WithVehicles() {
  Scenario scenario;
  scenario.host_vehicle.model = VehicleModel::kLongitudinal;
  scenario.follower_vehicle.model = VehicleModel::kLongitudinal;
  return scenario;
}

TEST(WorldTrafficTest, StartsEachFollowerItsGapBehindTheOneBefore) {
  Scenario scenario = WithFollowers(3);
  scenario.world.follower_gap_m = 25;
  scenario.world.vehicle_length_m = 5;
  world::World world(scenario);
  const truth_t& truth = Truth(world.Start(1));
  EXPECT_EQ(truth.num_followers, 3);
  EXPECT_EQ(truth.follower_position_m, (std::vector<double>{-30, -60, -90}));
  EXPECT_EQ(truth.follower_gap_m, (std::vector<double>{25, 25, 25}));
}

TEST(WorldTrafficTest, MovesEachFollowerByItsOwnCommand) {
  world::World world(WithFollowers(3));
  world.Start(1);
  const truth_t& truth = Truth(world.Step(HostCommand(0), FollowerCommands({1, -1, 2})));
  EXPECT_EQ(truth.follower_acceleration_mps2, (std::vector<double>{1, -1, 2}));
  EXPECT_DOUBLE_EQ(truth.follower_speed_mps[1], 19.9);
  // 1 m/s2 for 0.1 s moves a car by 5 mm.
  EXPECT_NEAR(truth.follower_gap_m[0], 33 - 0.005, 1e-12);
  EXPECT_NEAR(truth.follower_gap_m[1], 33 + 0.010, 1e-12);
  EXPECT_NEAR(truth.follower_gap_m[2], 33 - 0.015, 1e-12);
}

TEST(WorldTrafficTest, RefusesCommandsForAnotherNumberOfFollowers) {
  world::World world(WithFollowers(2));
  world.Start(1);
  EXPECT_THROW(world.Step(HostCommand(0), FollowerCommand(0)), std::invalid_argument);
  EXPECT_THROW(world.Step(HostCommand(0), FollowerCommands({0, 0, 0})), std::invalid_argument);
  EXPECT_NO_THROW(world.Step(HostCommand(0), FollowerCommands({0, 0})));
}

TEST(WorldTrafficTest, NoticesThatTheLastOfThemRunsIntoTheOneBefore) {
  Scenario scenario = WithFollowers(3);
  scenario.world.follower_gap_m = 1;
  world::World world(scenario);
  world.Start(1);
  const truth_t* truth = nullptr;
  for (int k = 0; k < 8; ++k) {
    truth = &Truth(world.Step(HostCommand(0), FollowerCommands({0, 0, 4})));
  }
  // 1 m at 4 m/s2 takes sqrt(2 / 4) s.
  EXPECT_EQ(truth->collision, truth_t::COLLISION_FOLLOWER);
  EXPECT_NEAR(truth->collision_time_s, std::sqrt(0.5), 1e-9);
}

TEST(WorldTrafficTest, ResumesAsManyCarsAsTheTruthHas) {
  world::World before(WithFollowers(3));
  before.Start(1);
  const truth_t truth = Truth(before.Step(HostCommand(-1), FollowerCommands({1, -1, 2})));
  world::World after(WithFollowers(3));
  after.Resume(truth);
  const truth_t& there = Truth(before.Step(HostCommand(2), FollowerCommands({0, 1, -3})));
  const truth_t& here = Truth(after.Step(HostCommand(2), FollowerCommands({0, 1, -3})));
  EXPECT_EQ(here.follower_position_m, there.follower_position_m);
  EXPECT_EQ(here.follower_gap_m, there.follower_gap_m);
  EXPECT_EQ(here.host_position_m, there.host_position_m);
  world::World other(WithFollowers(2));
  EXPECT_THROW(other.Resume(truth), std::invalid_argument);
}

TEST(WorldTrafficTest, FitsOneDatagramWithAsManyFollowersAsThereMayBe) {
  world::World world(WithFollowers(kMaxFollowers));
  EXPECT_LT(Truth(world.Start(1)).getEncodedSize(), static_cast<int>(runtime::kMaxMessageBytes));
  const std::vector<double> all(static_cast<std::size_t>(kMaxFollowers), 0.0);
  EXPECT_LT(FollowerCommands(all).getEncodedSize(), static_cast<int>(runtime::kMaxMessageBytes));
}

TEST(WorldVehicleTest, TakesTimeToDoWhatItIsTold) {
  // GIVEN a sedan with brakes that act after 0.1 s, and then gradually
  world::World world(WithVehicles());
  world.Start(1);
  // WHEN the sedan gets a command to brake
  const truth_t first = Truth(world.Step(HostCommand(-3), FollowerCommand(-3)));
  const truth_t second = Truth(world.Step(HostCommand(-3), FollowerCommand(-3)));
  truth_t later = second;
  for (int k = 0; k < 20; ++k) later = Truth(world.Step(HostCommand(-3), FollowerCommand(-3)));
  // THEN the sedan first does not brake, then partly, and in the end fully
  EXPECT_GT(first.host_acceleration_mps2, -0.5);
  EXPECT_LT(second.host_acceleration_mps2, first.host_acceleration_mps2);
  EXPECT_GT(second.host_acceleration_mps2, -2);
  EXPECT_NEAR(later.host_acceleration_mps2, -3, 0.05);
  EXPECT_EQ(later.follower_speed_mps[0], later.host_speed_mps) << "the same car";
}

TEST(WorldVehicleTest, LeavesTheOthersAlone) {
  Scenario scenario = WithVehicles();
  scenario.host_vehicle.model = VehicleModel::kPointMass;
  world::World world(scenario);
  world.Start(1);
  const truth_t& truth = Truth(world.Step(HostCommand(-3), FollowerCommand(-3)));
  EXPECT_EQ(truth.host_acceleration_mps2, -3);
  EXPECT_GT(truth.follower_acceleration_mps2[0], -0.5);
}

TEST(WorldVehicleTest, BrakesOnIceNoHarderThanItsTyresHold) {
  Scenario scenario = WithVehicles();
  scenario.road.surface = Surface::kIce;
  world::World world(scenario);
  world.Start(1);
  for (int k = 0; k < 30; ++k) {
    const truth_t& truth = Truth(world.Step(HostCommand(-6), FollowerCommand(-6)));
    // The tyres brake with at most mu g (mu = 0.15 on ice). Drag adds less than 0.2 m/s2 at 20 m/s.
    ASSERT_GE(truth.host_acceleration_mps2, -0.15 * models::kGravity_mps2 - 0.2);
  }
}

TEST(WorldVehicleTest, SubstepsChangeNothingButRoundingForVehiclesToo) {
  Scenario scenario = WithVehicles();
  scenario.road.grade = {{0, 0}, {50, 0.05}};
  Scenario fine = scenario;
  fine.world.substeps = 16;
  world::World a(scenario);
  world::World b(fine);
  a.Start(1);
  b.Start(1);
  for (int k = 0; k < 150; ++k) {
    const double command = k < 50 ? 2 : -4;  // the sedan comes to rest
    const truth_t& one = Truth(a.Step(HostCommand(command), FollowerCommand(command)));
    const truth_t& other = Truth(b.Step(HostCommand(command), FollowerCommand(command)));
    // The tolerance covers 150 steps with 16 roundings each, on positions of some hundred metres.
    ASSERT_NEAR(one.host_position_m, other.host_position_m, 1e-9) << k;
    ASSERT_NEAR(one.host_speed_mps, other.host_speed_mps, 1e-11) << k;
  }
  EXPECT_EQ(a.truth().host_speed_mps, 0);
}

TEST(WorldVehicleTest, StartsOverWithEveryRun) {
  world::World world(WithVehicles());
  std::vector<double> speeds[2];
  for (std::vector<double>& run : speeds) {
    world.Start(1);
    for (int k = 0; k < 30; ++k) {
      const double command = k < 10 ? -5 : -0.05;
      run.push_back(Truth(world.Step(HostCommand(command), FollowerCommand(0))).host_speed_mps);
    }
  }
  EXPECT_EQ(speeds[0], speeds[1]);
}

TEST(WorldVehicleTest, ResumesAsIfItHadKeptItsAccelerationForLong) {
  world::World before(WithVehicles());
  before.Start(1);
  truth_t truth;
  for (int k = 0; k < 30; ++k) truth = Truth(before.Step(HostCommand(-2), FollowerCommand(-2)));
  world::World after(WithVehicles());
  after.Resume(truth);
  const truth_t& here = Truth(after.Step(HostCommand(-2), FollowerCommand(-2)));
  const truth_t& there = Truth(before.Step(HostCommand(-2), FollowerCommand(-2)));
  // In both worlds engine and brakes have settled. The accelerations still differ a little, because
  // drag changes while the actuators lag by some tenths of a second.
  EXPECT_NEAR(here.host_acceleration_mps2, there.host_acceleration_mps2, 0.02);
}

std::string RefusalOf(const Scenario& scenario) {
  return test::ErrorOf([&scenario] { world::World world(scenario); });
}

TEST(WorldVehicleTest, RefusesARoadWhosePlacesDoNotIncrease) {
  Scenario scenario;
  scenario.road.grade = {{100, 0.01}, {100, 0.02}};
  EXPECT_EQ(RefusalOf(scenario),
            "/road/grade/1/position_m: 100 m does not come after 100 m, the place before it; "
            "places must increase");
}

TEST(WorldVehicleTest, RefusesAStepThatIsTooShortForItsDelays) {
  Scenario scenario = WithVehicles();
  scenario.host_vehicle.car = CarKind::kTruck;
  scenario.step_s = 0.001;
  EXPECT_EQ(RefusalOf(scenario),
            "/step_s: 0.001 s is too short for /host_vehicle: actuator: the delay is longer than "
            "254 steps");
}

}  // namespace
}  // namespace fogline
