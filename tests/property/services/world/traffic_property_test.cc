// Properties of whole runs with several followers. Some followers have human drivers. In some runs
// the cars have the vehicle model `longitudinal` in place of a point mass.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "services/closed_loop/closed_loop.h"
#include "services/models/vehicle/vehicle_parameters.h"
#include "tests/property/services/acc/draw.h"
#include "tests/unit/services/world/commands.h"

namespace fogline {
namespace {

Scenario Shipped() {
  return LoadScenario(FOGLINE_SOURCE_DIR "/scenario/paper.json", {"/world/end_on_collision=false"});
}

/// The paper's scenario with `count` followers of any kind.
Scenario Drawn(std::int64_t seed, std::int64_t count) {
  Scenario scenario = Shipped();
  scenario.seed = seed;
  scenario.followers.count = count;
  scenario.followers.driver = FollowerDriver::kDrawn;
  scenario.followers.style = FollowerStyle::kDrawn;
  return scenario;
}

std::vector<truth_t> TruthsOf(const Scenario& scenario) {
  std::vector<truth_t> truths;
  closed_loop::ClosedLoop loop(scenario);
  loop.Run(1, [&](const closed_loop::StepView& step) { truths.push_back(step.truth); });
  return truths;
}

TEST(TrafficProperty, NeverChangesTheHost) {
  for (std::int64_t seed = 1; seed <= 5; ++seed) {
    const std::vector<truth_t> one = TruthsOf(Drawn(seed, 1));
    const std::vector<truth_t> many = TruthsOf(Drawn(seed, 9));
    ASSERT_EQ(one.size(), many.size());
    for (std::size_t k = 0; k < one.size(); ++k) {
      ASSERT_EQ(one[k].host_position_m, many[k].host_position_m) << "step " << k;
      ASSERT_EQ(one[k].host_acceleration_mps2, many[k].host_acceleration_mps2) << "step " << k;
      ASSERT_EQ(one[k].preceding_position_m, many[k].preceding_position_m) << "step " << k;
    }
  }
}

TEST(TrafficProperty, NeverChangesACarFurtherAhead) {
  for (std::int64_t seed = 1; seed <= 5; ++seed) {
    const std::vector<truth_t> few = TruthsOf(Drawn(seed, 3));
    const std::vector<truth_t> many = TruthsOf(Drawn(seed, 8));
    for (std::size_t k = 0; k < few.size(); ++k) {
      for (std::size_t car = 0; car < 3; ++car) {
        ASSERT_EQ(few[k].follower_position_m[car], many[k].follower_position_m[car])
            << "car " << car << " step " << k;
      }
    }
  }
}

TEST(TrafficProperty, KeepsItsOrderBehindThePapersHost) {
  for (std::int64_t seed = 1; seed <= 20; ++seed) {
    const Scenario scenario = Drawn(seed, 12);
    for (const truth_t& truth : TruthsOf(scenario)) {
      ASSERT_EQ(truth.collision, truth_t::COLLISION_NONE) << "seed " << seed;
      double ahead_m = truth.host_position_m;
      for (std::size_t car = 0; car < 12; ++car) {
        const double rear_m = ahead_m - scenario.world.vehicle_length_m;
        ASSERT_LT(truth.follower_position_m[car], rear_m) << "seed " << seed << " car " << car;
        // Positions are some hundred metres. Each of three operations rounds by half an ulp,
        // together by less than 1e-12 m.
        ASSERT_NEAR(truth.follower_gap_m[car], rear_m - truth.follower_position_m[car], 1e-12);
        ahead_m = truth.follower_position_m[car];
      }
    }
  }
}

// The limits of a sedan's tyres and engine on this road, in m/s2.
struct Limits {
  double braking;
  double traction;
};

Limits LimitsOf(Surface surface, double steepest, double speed_mps) {
  const double drag = 0.5 * models::kAirDensity_kgpm3 * models::kSedan.drag_coefficient *
                      models::kSedan.frontal_area_m2 * speed_mps * speed_mps /
                      models::kSedan.mass_kg;
  const double slope = models::kGravity_mps2 * steepest;
  const double grip = models::FrictionOf(surface) * models::kGravity_mps2;
  return {.braking = grip + slope + drag,
          .traction = std::min(grip, models::kSedan.max_traction_mps2) + slope};
}

TEST(TrafficProperty, ObeysFrictionAndEngineAndNeverRollsBackwards) {
  constexpr double kSteepest = 0.1;
  Draw draw(5);
  int rested = 0;
  for (int run = 0; run < 60; ++run) {
    // GIVEN sedans on a hilly road (wet, dry or icy) that get impossible commands
    Scenario scenario;
    scenario.world.end_on_collision = false;
    scenario.world.substeps = draw.Integer(1, 4);
    scenario.followers.count = 3;
    scenario.road.surface = static_cast<Surface>(draw.Integer(0, 2));
    for (const double place_m : {-100.0, 50.0, 150.0, 400.0}) {
      scenario.road.grade.push_back({place_m, draw.Uniform(-kSteepest, kSteepest)});
    }
    scenario.host_vehicle.model = VehicleModel::kLongitudinal;
    scenario.follower_vehicle.model = VehicleModel::kLongitudinal;
    world::World world(scenario);
    truth_t before = std::get<truth_t>(world.Start(1));
    double host = 0;
    std::vector<double> followers(3);
    for (int k = 0; k < 200; ++k) {
      if (k % 15 == 0) host = draw.Uniform(-12, 6);
      for (double& one : followers) one = draw.Chance(0.1) ? draw.Uniform(-12, 6) : one;
      const truth_t now =
          std::get<truth_t>(world.Step(HostCommand(host), FollowerCommands(followers)));
      // THEN each sedan moves forwards within the limits of its tyres and its engine
      const Limits limits = LimitsOf(scenario.road.surface, kSteepest, before.host_speed_mps);
      ASSERT_GE(now.host_speed_mps, 0);
      ASSERT_GE(now.host_position_m, before.host_position_m);
      ASSERT_GE(now.host_acceleration_mps2, -limits.braking - 1e-9);
      ASSERT_LE(now.host_acceleration_mps2, limits.traction + 1e-9);
      for (std::size_t car = 0; car < 3; ++car) {
        const Limits own =
            LimitsOf(scenario.road.surface, kSteepest, before.follower_speed_mps[car]);
        ASSERT_GE(now.follower_speed_mps[car], 0);
        ASSERT_GE(now.follower_position_m[car], before.follower_position_m[car]);
        ASSERT_GE(now.follower_acceleration_mps2[car], -own.braking - 1e-9);
        ASSERT_LE(now.follower_acceleration_mps2[car], own.traction + 1e-9);
        // The reported acceleration is the change of speed divided by the step, as for a point
        // mass.
        ASSERT_NEAR(now.follower_acceleration_mps2[car],
                    (now.follower_speed_mps[car] - before.follower_speed_mps[car]) / 0.1, 1e-10);
      }
      if (now.host_speed_mps == 0 && before.host_speed_mps > 0) ++rested;
      before = now;
    }
  }
  EXPECT_GT(rested, 10) << "the runs must have stops to say something";
}

}  // namespace
}  // namespace fogline
