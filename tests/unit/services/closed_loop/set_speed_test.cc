// After the fog the ACC closes the gap that has grown in the fog. The ACC's set speed limits the
// host's speed.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "services/closed_loop/closed_loop.h"
#include "services/metrics/run_metrics.h"

namespace fogline {
namespace {

struct Chase {
  double fastest_mps = 0;
  double min_ttc_s = 0;
};

/// Runs dense_fog.json with policy "none", so the automation always drives the host.
Chase Drive(std::vector<std::string> overrides) {
  overrides.emplace_back("/arbitrator/policy=none");
  const Scenario scenario =
      LoadScenario(std::string(FOGLINE_SOURCE_DIR) + "/scenario/dense_fog.json", overrides);
  Chase chase;
  metrics::MetricsAccumulator measures(scenario);
  closed_loop::ClosedLoop(scenario).Run(0, [&](const closed_loop::StepView& step) {
    measures.Add(step.ToSample());
    chase.fastest_mps = std::max(chase.fastest_mps, step.truth.host_speed_mps);
  });
  chase.min_ttc_s = measures.Result().host.min_ttc_s.value();
  return chase;
}

TEST(SetSpeedTest, OfFortyMetresPerSecondLetsTheHostChaseTheCarAhead) {
  const Chase chase = Drive({});
  EXPECT_NEAR(chase.fastest_mps, 33.0, 0.1);
  EXPECT_NEAR(chase.min_ttc_s, 4.96, 0.01);
}

TEST(SetSpeedTest, NearTheSpeedOfTheCarAheadMakesTheApproachGentle) {
  const Chase chase = Drive({"/acc/max_speed_mps=22"});
  EXPECT_LE(chase.fastest_mps, 22 + 1e-9);
  EXPECT_GT(chase.fastest_mps, 21.9) << "it is the speed on the free road before the car ahead";
  EXPECT_NEAR(chase.min_ttc_s, 39.7, 0.1);
}

}  // namespace
}  // namespace fogline
