// A closed loop that was restarted any number of times computes the same run as a new one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/sections/decision.h"
#include "tests/property/services/acc/draw.h"
#include "tests/property/services/closed_loop/shipped.h"

namespace fogline::test {
namespace {

std::vector<Shipped> Scenarios() { return ShippedScenarios(FOGLINE_SOURCE_DIR "/scenario"); }

std::string FreshDigest(const Scenario& scenario) {
  closed_loop::ClosedLoop loop(scenario);
  return DigestOf(loop);
}

void ChangeTraffic(Draw& draw, Scenario& scenario) {
  if (draw.Chance(0.3)) scenario.followers.count = draw.Integer(1, 5);
  scenario.followers.driver = static_cast<FollowerDriver>(draw.Integer(0, 2));
  scenario.followers.style = static_cast<FollowerStyle>(draw.Integer(0, 3));
  scenario.followers.safety_model = static_cast<SafetyModelChoice>(draw.Integer(0, 3));
  scenario.host_vehicle.model = static_cast<VehicleModel>(draw.Integer(0, 1));
  scenario.follower_vehicle.model = static_cast<VehicleModel>(draw.Integer(0, 1));
  scenario.follower_vehicle.car = static_cast<CarKind>(draw.Integer(0, 2));
  scenario.road.surface = static_cast<Surface>(draw.Integer(0, 2));
  scenario.road.grade = {{0, draw.Uniform(-0.05, 0.05)}, {500, draw.Uniform(-0.05, 0.05)}};
}

/// Changes some parameters of a scenario at random, such as those that differ between the runs of a
/// sweep.
void Change(Draw& draw, Scenario& scenario) {
  if (draw.Chance(0.5)) scenario.seed = draw.Integer(0, 1000);
  scenario.steps = draw.Integer(1, 300);
  scenario.fog.model = static_cast<FogModel>(draw.Integer(0, 2));
  scenario.arbitrator.policy = static_cast<Policy>(
      draw.Integer(0, static_cast<std::int64_t>(ChoiceNames<Policy>::kNames.size()) - 1));
  scenario.arbitrator.transfer.profile = static_cast<TransferProfile>(draw.Integer(0, 3));
  scenario.arbitrator.transfer.gate = draw.Chance(0.3);
  scenario.arbitrator.threshold = draw.Uniform(0, 1);
  scenario.arbitrator.window_steps = draw.Integer(1, 20);
  // With short gaps the ACC needs its active-set solver. The solver has a state that a restart must
  // clear.
  scenario.world.host_gap_m = draw.Uniform(8, 40);
  scenario.world.follower_gap_m = draw.Uniform(8, 40);
  if (draw.Chance(0.3)) scenario.acc.horizon_steps = draw.Integer(5, 40);
  if (draw.Chance(0.3)) scenario.acc.max_track_std_m = draw.Uniform(0.01, 1);
  if (draw.Chance(0.3)) scenario.follower.weight_speed = draw.Uniform(0.1, 5);
  if (draw.Chance(0.2)) scenario.step_s = draw.Uniform(0.05, 0.2);
  scenario.human.misjudges = draw.Chance(0.3);
  scenario.human.loses_awareness = draw.Chance(0.3);
  ChangeTraffic(draw, scenario);
}

TEST(ClosedLoopProperty, RestartsAsIfNewWhateverRanBefore) {
  // GIVEN a loop that may already have computed other runs
  Draw draw(1);
  Scenario scenario;
  closed_loop::ClosedLoop loop(scenario);
  std::vector<std::string> digests;
  for (int i = 0; i < 60; ++i) {
    // WHEN the loop restarts with the same or with other parameters, after a run or without one
    Change(draw, scenario);
    loop.Restart(scenario);
    if (draw.Chance(0.2)) continue;
    // THEN every message of the run has the same bits as in a new loop
    digests.push_back(DigestOf(loop));
    EXPECT_EQ(digests.back(), FreshDigest(scenario)) << "restart " << i;
  }
  std::ranges::sort(digests);
  EXPECT_GT(std::unique(digests.begin(), digests.end()) - digests.begin(), 40)
      << "the runs differ, so equality says something";
}

TEST(ClosedLoopProperty, RepeatsEveryShippedScenarioBitByBit) {
  const std::vector<Shipped> shipped = Scenarios();
  ASSERT_GE(shipped.size(), 2U);
  closed_loop::ClosedLoop loop(shipped.front().scenario);
  for (int round = 0; round < 2; ++round) {
    for (const Shipped& one : shipped) {
      loop.Restart(one.scenario);
      EXPECT_EQ(DigestOf(loop), FreshDigest(one.scenario)) << one.name;
    }
  }
}

TEST(ClosedLoopProperty, RefusesAnAccWithoutAWellConditionedProblemAndGoesOnWithTheNext) {
  Scenario scenario;
  closed_loop::ClosedLoop loop(scenario);
  Scenario impossible;
  impossible.step_s = 1;
  impossible.acc.horizon_steps = 60;
  impossible.acc.headway_s = 0;
  impossible.acc.engine_gain = 10;
  impossible.acc.weight_distance = 1e6;
  impossible.acc.weight_speed = 0;
  impossible.acc.weight_acceleration = 0;
  impossible.acc.weight_control = 1e-6;
  impossible.acc.weight_control_change = 0;
  EXPECT_THROW(loop.Restart(impossible), InputError);
  loop.Restart(scenario);
  EXPECT_EQ(DigestOf(loop), FreshDigest(scenario));
}

}  // namespace
}  // namespace fogline::test
