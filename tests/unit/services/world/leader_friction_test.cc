#include "services/world/leader_friction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "common/errors.h"
#include "services/world/world.h"
#include "tests/unit/services/world/commands.h"

namespace fogline {
namespace {

constexpr double kIce_mps2 = 0.15 * 9.80665;

Scenario OnIce(LeadProfile profile) {
  Scenario scenario;
  scenario.host_vehicle.model = VehicleModel::kLongitudinal;
  scenario.road.surface = Surface::kIce;
  scenario.lead.profile = profile;
  return scenario;
}

std::string Refusal(const Scenario& scenario) {
  try {
    const world::World world(scenario);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(LeaderFrictionTest, RefusesABrakingThatIceDoesNotAllow) {
  Scenario scenario = OnIce(LeadProfile::kEmergencyBrake);
  EXPECT_EQ(Refusal(scenario),
            "/lead/emergency_brake/deceleration_mps2: 6 m/s2; no tyre on this road brakes harder "
            "than 1.471 m/s2 (/road/surface is \"ice\", friction 0.15)");
  scenario.lead.emergency_brake.deceleration_mps2 = 1.4;
  EXPECT_EQ(Refusal(scenario), "");
  scenario.lead.emergency_brake.deceleration_mps2 = kIce_mps2;
  EXPECT_EQ(Refusal(scenario), "") << "the limit itself is possible";
}

TEST(LeaderFrictionTest, RefusesTheHardestOfTheBreakpoints) {
  Scenario scenario = OnIce(LeadProfile::kBreakpoints);
  scenario.lead.breakpoints = {{10.0, 25.0}, {5.0, 20.0}, {4.0, 10.0}, {5.0, 15.0}};
  EXPECT_EQ(
      Refusal(scenario),
      "/lead/breakpoints/2/speed_mps: 10 m/s, 4 s after 20 m/s, is a braking of 2.500 m/s2; no "
      "tyre on this road brakes harder than 1.471 m/s2 (/road/surface is \"ice\", friction "
      "0.15)");
  scenario.lead.breakpoints[2].duration_s = 7.0;
  EXPECT_EQ(Refusal(scenario), "");
}

TEST(LeaderFrictionTest, RefusesASineThatIsTooSteep) {
  Scenario scenario = OnIce(LeadProfile::kSinusoid);
  EXPECT_EQ(Refusal(scenario), "") << "by default at most 0.63 m/s2";
  scenario.lead.sinusoid = {.amplitude_mps = 10.0, .period_s = 20.0};
  EXPECT_EQ(Refusal(scenario).find("/lead/sinusoid/amplitude_mps: 10 m/s within a period of 20 s "
                                   "is a braking of up to 3.142 m/s2; no "),
            0U)
      << Refusal(scenario);
}

TEST(LeaderFrictionTest, AllowsWhatAProfileDoesNotDo) {
  Scenario scenario = OnIce(LeadProfile::kEmergencyBrake);
  scenario.lead.emergency_brake.final_speed_mps = scenario.lead.speed_mps;
  EXPECT_EQ(Refusal(scenario), "");
  scenario.lead.profile = LeadProfile::kConstant;
  EXPECT_EQ(Refusal(scenario), "");
}

TEST(LeaderFrictionTest, LimitsNoLeaderAmongPointMasses) {
  Scenario scenario = OnIce(LeadProfile::kEmergencyBrake);
  scenario.host_vehicle.model = VehicleModel::kPointMass;
  EXPECT_EQ(Refusal(scenario), "");
  const world::LeaderFriction friction(scenario, {});
  EXPECT_EQ(friction.Limited(-12.0, 0.0), -12.0);
  scenario.follower_vehicle.model = VehicleModel::kLongitudinal;
  EXPECT_NE(Refusal(scenario), "") << "a following car has tyres";
}

TEST(LeaderFrictionTest, AllowsOnARiseWhatTheRiseAdds) {
  Scenario scenario = OnIce(LeadProfile::kEmergencyBrake);
  scenario.lead.emergency_brake.deceleration_mps2 = 2.0;
  EXPECT_NE(Refusal(scenario), "");
  scenario.road.grade = {{0.0, -0.05}, {500.0, 0.1}};  // g (mu + grade) / sqrt(1 + grade^2) = 2.44
  EXPECT_EQ(Refusal(scenario), "");
  const world::LeaderFriction friction(scenario, models::GradeProfile(scenario.road.grade));
  EXPECT_NEAR(friction.Limited(-2.0, 0.0), -9.80665 * 0.10 / std::sqrt(1.0025), 1e-12);
  EXPECT_EQ(friction.Limited(-2.0, 500.0), -2.0);
  EXPECT_EQ(friction.Limited(3.0, 0.0), 3.0) << "accelerations are those of the profile";
}

TEST(LeaderFrictionTest, HoldsNothingOnADescentSteeperThanTheFriction) {
  Scenario scenario = OnIce(LeadProfile::kConstant);
  scenario.road.grade = {{0.0, -0.2}};
  const world::LeaderFriction friction(scenario, models::GradeProfile(scenario.road.grade));
  EXPECT_EQ(friction.Limited(-1.0, 0.0), 0.0);
}

// The recording stops from 20 m/s within 1 s. On ice the car needs 13.6 s to stop. After this stop
// the car stands still like its recording.
TEST(LeaderFrictionTest, LetsARecordedCarBrakeAsHardAsItCan) {
  Scenario scenario = OnIce(LeadProfile::kRecorded);
  scenario.steps = 300;
  scenario.world.host_gap_m = 500;
  scenario.lead.recorded.speeds_mps = {20, 20, 18, 16, 14, 12, 10, 8, 6, 4, 2, 0};
  world::World world(scenario);
  truth_t before = std::get<truth_t>(world.Start(1));
  int braking_steps = 0;
  for (int step = 1; step < 200; ++step) {
    const truth_t truth = std::get<truth_t>(world.Step(HostCommand(0.0), FollowerCommand(0.0)));
    EXPECT_GE(truth.preceding_acceleration_mps2, -kIce_mps2 - 1e-9);
    EXPECT_GE(truth.preceding_speed_mps, world::Leader(scenario.lead).SpeedAt(step, 0.0));
    EXPECT_NEAR(truth.preceding_position_m - before.preceding_position_m,
                0.05 * (truth.preceding_speed_mps + before.preceding_speed_mps), 0.01);
    if (truth.preceding_speed_mps < before.preceding_speed_mps) ++braking_steps;
    before = truth;
  }
  EXPECT_EQ(before.preceding_speed_mps, 0.0);
  EXPECT_EQ(braking_steps, 136) << "20 / 1.471 = 13.60 s";
}

TEST(LeaderFrictionTest, LeavesARecordingOnADryRoadAsItIs) {
  Scenario scenario = OnIce(LeadProfile::kRecorded);
  scenario.road.surface = Surface::kDry;
  scenario.world.host_gap_m = 500;
  scenario.lead.recorded.speeds_mps = {20, 19.3, 18.5, 17.7, 17.7, 18.4, 18.1};
  world::World world(scenario);
  world.Start(1);
  for (std::size_t step = 1; step < 10; ++step) {
    const truth_t& truth = std::get<truth_t>(world.Step(HostCommand(0.0), FollowerCommand(0.0)));
    const std::size_t row = std::min(step, scenario.lead.recorded.speeds_mps.size() - 1);
    EXPECT_EQ(truth.preceding_speed_mps, scenario.lead.recorded.speeds_mps[row]);
  }
}

}  // namespace
}  // namespace fogline
