// Scenarios with random parameters.
#pragma once

#include <cstdint>

#include "scenario/sections/decision.h"
#include "scenario/sections/scenario.h"
#include "tests/property/services/acc/draw.h"

namespace fogline::test {

inline void ChangeTraffic(Draw& draw, Scenario& scenario) {
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

/// Changes the arbitrator of a scenario at random.
inline void ChangeArbitrator(Draw& draw, Scenario& scenario) {
  scenario.arbitrator.policy = static_cast<Policy>(
      draw.Integer(0, static_cast<std::int64_t>(ChoiceNames<Policy>::kNames.size()) - 1));
  scenario.arbitrator.transfer.profile = static_cast<TransferProfile>(draw.Integer(0, 3));
  scenario.arbitrator.transfer.gate = draw.Chance(0.3);
  scenario.arbitrator.threshold = draw.Uniform(0, 1);
  scenario.arbitrator.window_steps = draw.Integer(1, 20);
  scenario.arbitrator.take_over.mode =
      draw.Chance(0.3) ? TakeOverMode::kRequested : TakeOverMode::kInstant;
}

/// Changes some parameters of a scenario at random, such as those that differ between the runs of a
/// sweep.
inline void ChangeScenario(Draw& draw, Scenario& scenario) {
  if (draw.Chance(0.5)) scenario.seed = draw.Integer(0, 1000);
  scenario.steps = draw.Integer(1, 300);
  scenario.fog.model = static_cast<FogModel>(draw.Integer(0, 2));
  ChangeArbitrator(draw, scenario);
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

}  // namespace fogline::test
