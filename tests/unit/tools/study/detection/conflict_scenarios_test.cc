#include "tools/study/detection/conflict_scenarios.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/tools/study/few_seeds.h"
#include "tools/study/detection/conflict_runs.h"
#include "tools/study/detection/runs/clear_air.h"

namespace fogline {
namespace {

const study::ConflictSituation kSituation{"bias", study::ConflictNoises()[1]};

TEST(ConflictScenarioTest, HasFogFromTheEndOfTheWarmUpOrNoFog) {
  const study::StudyContext context = test::FewSeeds(1, 1);
  const Scenario fog = study::ScenarioInFog(context, kSituation, 100);
  EXPECT_EQ(fog.fog.start_s, study::kWarmUp_s);
  EXPECT_EQ(fog.fog.duration_s, study::kFog_s);
  EXPECT_EQ(fog.fog.visibility_m, 100);
  EXPECT_EQ(fog.steps, std::llround((study::kWarmUp_s + study::kFog_s) / fog.step_s) + 1);
  const Scenario clear = study::ScenarioInClearAir(context, kSituation);
  EXPECT_EQ(clear.fog.duration_s, 0);
  EXPECT_EQ(clear.steps, std::llround((study::kWarmUp_s + study::kClearRun_s) / clear.step_s) + 1);
}

TEST(ConflictScenarioTest, HasABiasThatIsLargerInDenserFog) {
  const study::StudyContext context = test::FewSeeds(1, 1);
  const double papers_m = context.Load("paper.json", {}).fog.bias_m;
  const auto bias_m = [&](double visibility_m) {
    return study::ScenarioInFog(context, kSituation, visibility_m).fog.bias_m;
  };
  EXPECT_DOUBLE_EQ(bias_m(study::kReferenceVisibility_m), papers_m);
  EXPECT_DOUBLE_EQ(bias_m(2 * study::kReferenceVisibility_m), papers_m / 2);
  EXPECT_DOUBLE_EQ(bias_m(study::kReferenceVisibility_m / 2), 2 * papers_m);
}

TEST(ConflictScenarioTest, LetsTheMeasuresSubtractTheMountingOffsetOfTheSensors) {
  const study::StudyContext context = test::FewSeeds(1, 1);
  study::ConflictSituation mounted = kSituation;
  mounted.other = {"/radar/bias_m=0.9", "/lidar/bias_m=0.2"};
  for (const Scenario& scenario :
       {study::ScenarioInFog(context, mounted, 100), study::ScenarioInClearAir(context, mounted)}) {
    EXPECT_DOUBLE_EQ(scenario.arbitrator.measure_offset_m, 0.9 - 0.2) << "radar minus LiDAR";
  }
}

TEST(ConflictScenarioTest, HasTheNoiseOfItsSituationInSensorsAndFilter) {
  for (const study::ConflictNoise& noise : study::ConflictNoises()) {
    const Scenario scenario =
        study::ScenarioInClearAir(test::FewSeeds(1, 1), {.fog = "beam", .noise = noise});
    EXPECT_EQ(scenario.fog.model, FogModel::kBeam);
    EXPECT_EQ(scenario.radar.range_std_m, noise.radar_m);
    EXPECT_EQ(scenario.lidar.range_std_m, noise.lidar_m);
    EXPECT_GE(scenario.fusion.radar_range_std_m, noise.radar_m);
    EXPECT_EQ(scenario.fusion.lidar_range_std_m, noise.lidar_m);
  }
}

TEST(ConflictSeedsTest, NoSeedServesTwoPurposes) {
  const sweep::SeedRange seeds = study::FindStudy("conflict")->seeds;
  std::vector<std::pair<std::int64_t, std::int64_t>> used{
      {seeds.first, seeds.last},
      {study::kCalibrationSeeds + seeds.first, study::kCalibrationSeeds + seeds.last},
      {study::kValidationSeeds + seeds.first, study::kValidationSeeds + seeds.last},
      {study::kFurtherClearAirSeeds + study::kQuickClearAir * seeds.first,
       study::kFurtherClearAirSeeds + study::kQuickClearAir * (seeds.last + 1) - 1}};
  std::ranges::sort(used);
  for (std::size_t i = 1; i < used.size(); ++i) EXPECT_GT(used[i].first, used[i - 1].second) << i;
}

}  // namespace
}  // namespace fogline
