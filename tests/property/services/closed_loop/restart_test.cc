// A closed loop that was restarted any number of times computes the same run as a new one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/property/services/closed_loop/drawn_scenario.h"
#include "tests/property/services/closed_loop/shipped.h"

namespace fogline::test {
namespace {

std::vector<Shipped> Scenarios() { return ShippedScenarios(FOGLINE_SOURCE_DIR "/scenario"); }

TEST(ClosedLoopProperty, RestartsAsIfNewWhateverRanBefore) {
  // GIVEN a loop that may already have computed other runs
  Draw draw(1);
  Scenario scenario;
  closed_loop::ClosedLoop loop(scenario);
  std::vector<std::string> digests;
  for (int i = 0; i < 60; ++i) {
    // WHEN the loop restarts with the same or with other parameters, after a run or without one
    ChangeScenario(draw, scenario);
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
