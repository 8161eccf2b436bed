#include "tools/calibrate/steady_start.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "services/closed_loop/closed_loop.h"
#include "tests/support/command.h"
#include "tests/support/input_errors.h"

namespace fogline {
namespace {

Scenario Paper(const std::vector<std::string>& overrides = {}) {
  return LoadScenario(test::SourceDirectory() / "scenario/paper.json", overrides);
}

TEST(SteadyStartTest, DerivesTheGapsThatAPersonDerivedForPaperJson) {
  Scenario scenario = Paper({"/world/host_gap_m=1", "/acc/standstill_m=0"});
  const auto derived = calibrate::StartSteadily(scenario);
  ASSERT_EQ(derived.size(), calibrate::kSteadyFields.size());
  EXPECT_EQ(derived[0].pointer, "/world/host_gap_m");
  // paper.json has the same values, but its standstill_m is rounded to 1 mm. StartSteadily() rounds
  // to 0.1 mm.
  EXPECT_DOUBLE_EQ(scenario.world.host_gap_m, 36.4445);
  EXPECT_NEAR(scenario.acc.standstill_m, 4.5, 1e-3);
  EXPECT_DOUBLE_EQ(scenario.world.follower_gap_m, 39);
  EXPECT_EQ(derived[1].value, scenario.acc.standstill_m);
}

TEST(SteadyStartTest, LetsNoCarAccelerateInClearAir) {
  for (const char* policy : {"none", "traded"}) {
    // GIVEN sensors without noise, a human who drives never (policy none) or always (threshold 0),
    // and some other values than those of paper.json
    Scenario scenario =
        Paper({"/fog/model=none", std::string("/arbitrator/policy=") + policy,
               "/arbitrator/threshold=0", "/radar/range_std_m=0", "/radar/range_rate_std_mps=0",
               "/lidar/range_std_m=0", "/lidar/bias_m=-0.1", "/acc/headway_s=1.2",
               "/driver/headway_s=1.4", "/fusion/radar_range_std_m=0.02", "/follower/headway_s=2"});
    // WHEN the run begins with the derived gaps
    calibrate::StartSteadily(scenario);
    double most = 0;
    closed_loop::ReusedLoop loop;
    loop.Run(scenario, [&](const closed_loop::StepView& step) {
      const auto sample = step.ToSample();
      most = std::max(
          {most, std::abs(sample.host_speed_mps - 20), std::abs(sample.follower_speed_mps - 20)});
    });
    // THEN the speeds are constant, apart from the rounding of the gaps to 0.1 mm
    EXPECT_LT(most, 1e-3) << policy;
  }
}

TEST(SteadyStartTest, SaysWhyThereIsNoSteadyStart) {
  const auto error_with = [](const char* field) {
    return test::ErrorOf([&] {
      Scenario scenario = Paper({field});
      calibrate::StartSteadily(scenario);
    });
  };
  EXPECT_EQ(error_with("/lead/speed_mps=21"),
            "error: --steady: the cars differ in speed at step 0");
  EXPECT_EQ(error_with("/human/following=iidm"),
            "error: --steady: /human/following is not idm, the model whose equilibrium is known");
  EXPECT_EQ(error_with("/driver/desired_speed_mps=20"),
            "error: --steady: /driver/desired_speed_mps is not above /world/host_speed_mps");
  EXPECT_EQ(error_with("/acc/headway_s=2"),
            "error: --steady: /acc/standstill_m would be -3.4998 m");
}

}  // namespace
}  // namespace fogline
