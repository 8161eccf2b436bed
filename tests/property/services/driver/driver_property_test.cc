// Properties of the host's driver in whole runs, with random weaknesses of the driver.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "services/closed_loop/closed_loop.h"
#include "services/models/driver/idm.h"
#include "tests/property/services/acc/draw.h"

namespace fogline::test {
namespace {

Scenario AnyRoad(Draw& draw) {
  Scenario scenario;
  scenario.seed = draw.Integer(0, 1000);
  scenario.steps = 200;
  scenario.fog.model = static_cast<FogModel>(draw.Integer(0, 2));
  scenario.fog.start_s = draw.Uniform(0, 5);
  scenario.fog.visibility_m = draw.LogUniform(10, 500);
  scenario.arbitrator.threshold = draw.Uniform(0, 1);
  scenario.world.host_gap_m = draw.Uniform(5, 60);
  return scenario;
}

HumanSection AnyHuman(Draw& draw) {
  HumanSection human;
  human.following = static_cast<FollowingModel>(draw.Integer(0, 2));
  human.sight = draw.Chance(0.5) ? Sight::kFog : Sight::kPerfect;
  human.misjudges = draw.Chance(0.5);
  human.loses_awareness = draw.Chance(0.5);
  human.errors.reaction_time_s = draw.Uniform(0, 3);
  human.errors.gap_error = draw.Uniform(0, 1);
  human.errors.approach_error_ps = draw.Uniform(0, 0.2);
  human.errors.anticipates = draw.Chance(0.5);
  human.awareness.monitoring = draw.Uniform(0, 1);
  human.awareness.fading_s = draw.LogUniform(0.1, 1e4);
  human.awareness.recovery_ps = draw.LogUniform(0.001, 100);
  return human;
}

constexpr int kRuns = 150;

TEST(DriverProperty, StaysWithinTheLimitsOfTheCarAndOfAwarenessWhateverIsHumanAboutHim) {
  Draw draw(5);
  for (int run = 0; run < kRuns; ++run) {
    Scenario scenario = AnyRoad(draw);
    scenario.human = AnyHuman(draw);
    const double least = std::min(scenario.driver.readiness, scenario.human.awareness.monitoring);
    closed_loop::ClosedLoop(scenario).Run(1, [&](const closed_loop::StepView& step) {
      const driver_command_t& command = step.driver;
      ASSERT_TRUE(std::isfinite(command.acceleration_mps2));
      ASSERT_GE(command.acceleration_mps2, -scenario.driver.max_deceleration_mps2);
      ASSERT_LE(command.acceleration_mps2, scenario.driver.max_acceleration_mps2);
      ASSERT_LE(command.readiness, 1);
      // Rounding may put the readiness a few ulp below the value to which it fades.
      ASSERT_GE(command.readiness, least - 1e-12);
    });
  }
}

TEST(DriverProperty, IsThePapersBitByBitWithEverySwitchOffWhateverTheOtherNumbersAre) {
  Draw draw(6);
  for (int run = 0; run < kRuns; ++run) {
    Scenario scenario = AnyRoad(draw);
    scenario.human = AnyHuman(draw);
    scenario.human.following = FollowingModel::kIdm;
    scenario.human.sight = Sight::kPerfect;
    scenario.human.misjudges = false;
    scenario.human.loses_awareness = false;
    const models::Idm idm(scenario.driver);
    closed_loop::ClosedLoop(scenario).Run(1, [&](const closed_loop::StepView& step) {
      const truth_t& truth = step.truth;
      ASSERT_EQ(
          step.driver.acceleration_mps2,
          idm.Acceleration(truth.host_speed_mps, truth.preceding_speed_mps, truth.host_gap_m));
      ASSERT_EQ(step.driver.readiness, scenario.driver.readiness);
    });
  }
}

TEST(DriverProperty, GainsAwarenessInAStepIfAndOnlyIfHeDroveInTheOneBefore) {
  Draw draw(7);
  int driven = 0;
  for (int run = 0; run < kRuns; ++run) {
    Scenario scenario = AnyRoad(draw);
    scenario.human = AnyHuman(draw);
    scenario.human.loses_awareness = true;
    std::optional<double> before;
    std::int8_t mode = arbitration_t::AUTOMATION;
    closed_loop::ClosedLoop(scenario).Run(1, [&](const closed_loop::StepView& step) {
      const double now = step.driver.readiness;
      if (before && mode == arbitration_t::HUMAN) {
        ASSERT_TRUE(now > *before || now == 1);
        ++driven;
      } else if (before) {
        ASSERT_LE(now, *before + 1e-12);
      }
      before = now;
      mode = step.host.mode;
    });
  }
  EXPECT_GT(driven, 1000) << "or nothing was shown";
}

}  // namespace
}  // namespace fogline::test
