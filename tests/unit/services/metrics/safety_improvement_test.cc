#include "services/metrics/safety_improvement.h"

#include <cstddef>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/services/metrics/example_runs.h"

namespace fogline {
namespace {

TEST(SafetyImprovementTest, IsFiftyPercentWhereEveryShortfallIsHalved) {
  const auto baseline = FoggyRun({1, 2, 4});
  const auto traded = FoggyRun({0.5, 1, 2});
  EXPECT_EQ(metrics::SafetyImprovementPct(baseline, traded, 0), 50);
}

TEST(SafetyImprovementTest, IsTheMeanOfTheStepsRatios) {
  // The ratios 1 - traded/baseline of the steps are 1 - 0/1 = 1, 1 - 3/2 = -1/2 and 1 - 1/4 = 3/4.
  // Their mean is 5/12.
  const auto baseline = FoggyRun({1, 2, 4});
  const auto traded = FoggyRun({0, 3, 1});
  EXPECT_NEAR(*metrics::SafetyImprovementPct(baseline, traded, 0), 100 * 5.0 / 12, 1e-12);
}

TEST(SafetyImprovementTest, LooksOnlyAtFogAndAboveTheFloor) {
  auto baseline = FoggyRun({1, 0.25, 1, 0});
  const auto traded = FoggyRun({0.25, 9, 9, 9});
  baseline[2].fog_present = false;
  // Step 1 is at the floor, step 2 is in clear air, step 3 has nothing to improve.
  EXPECT_EQ(metrics::SafetyImprovementPct(baseline, traded, 0.25), 75);
}

TEST(SafetyImprovementTest, HasNoValueWithoutARelevantStep) {
  const auto clear = QuietRun(3);
  const auto safe = FoggyRun({0, 0, 0});
  EXPECT_EQ(metrics::SafetyImprovementPct(clear, clear, 0), std::nullopt);
  EXPECT_EQ(metrics::SafetyImprovementPct(safe, FoggyRun({1, 1, 1}), 0), std::nullopt);
  EXPECT_EQ(metrics::SafetyImprovementPct({}, {}, 0), std::nullopt);
}

TEST(SafetyImprovementTest, ComparesTheStepsThatBothRunsReached) {
  const auto baseline = FoggyRun({1, 1});
  const auto traded = FoggyRun({0, 0.5, 1, 1});
  EXPECT_EQ(metrics::SafetyImprovementPct(baseline, traded, 0), 75);
  EXPECT_EQ(metrics::SafetyImprovementPct(traded, baseline, 0), -100);  // only step 1 is relevant
}

TEST(SafetyImprovementTest, RefusesToPairDifferentSteps) {
  const auto baseline = FoggyRun({1, 1, 1});
  auto traded = baseline;
  traded[1].step = 7;
  try {
    metrics::SafetyImprovementPct(baseline, traded, 0);
    FAIL() << "paired step 1 with step 7";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "safety improvement: step 1 of the baseline does not pair with step 7");
  }
}

// 8 steps with fog in steps 1 and 2. In every step the following car is too near by 1 m.
std::vector<metrics::Sample> BesideFog() {
  std::vector<metrics::Sample> run = FoggyRun(std::vector<double>(8, 1.0));
  for (const std::size_t k : {0, 3, 4, 5, 6, 7}) run[k].fog_present = false;
  return run;
}

Scenario WithFloor(double floor_m) {
  Scenario scenario;
  scenario.measures.safety_floor_m = floor_m;
  return scenario;
}

TEST(PairedMeasuresTest, SafetyIsCountedUntilTheTracksOfBothRunsAreRightAgain) {
  auto baseline = BesideFog();
  auto traded = BesideFog();
  for (metrics::Sample& sample : traded) sample.follower_gap_m = 32;  // nothing is compromised
  traded[4].follower_gap_m = 30;                                      // 2 m too near; baseline: 1 m
  // Only the steps in fog count, because the track is right at the end of the fog.
  EXPECT_EQ(metrics::MeasurePair(baseline, traded, {}).si_until_recovery_pct, 100);
  // If the track of one of the two runs is wrong until step 4, steps 1 to 4 count.
  traded[4].fused_distance_m = 20;
  EXPECT_EQ(metrics::MeasurePair(baseline, traded, {}).si_until_recovery_pct, 50);
  traded[4].fused_distance_m = 30;
  baseline[4].fused_distance_m = 20;
  EXPECT_EQ(metrics::MeasurePair(baseline, traded, {}).si_until_recovery_pct, 50);
  EXPECT_EQ(metrics::MeasurePair(baseline, traded, {}).si_pct, 100);
}

TEST(PairedMeasuresTest, HaveTheFloorOfTheScenario) {
  const auto baseline = FoggyRun({1, 0.25});
  const auto traded = FoggyRun({0, 0.25});
  EXPECT_EQ(metrics::MeasurePair(baseline, traded, WithFloor(0.5)).si_pct, 100);
  EXPECT_EQ(metrics::MeasurePair(baseline, traded, WithFloor(0.5)).si_until_recovery_pct, 100);
  EXPECT_EQ(metrics::MeasurePair(baseline, traded, WithFloor(0.1)).si_pct, 50);
  EXPECT_EQ(metrics::MeasurePair(baseline, traded, WithFloor(0.1)).si_until_recovery_pct, 50);
  EXPECT_EQ(metrics::MeasurePair(baseline, traded, WithFloor(2)).si_until_recovery_pct,
            std::nullopt);
}

// Position of a choice in PairedMetrics::other_si_pct.
std::size_t PlaceOf(std::string_view name) {
  for (std::size_t i = 0; i < metrics::kSafetyChoices.size(); ++i) {
    if (metrics::kSafetyChoices[i].name == name) return i;
  }
  throw std::out_of_range(std::string(name));
}

TEST(PairedMeasuresTest, HaveSafetyWithOtherFloors) {
  const auto baseline = FoggyRun({0.5, 0.015, 0.007, 0.002, 0.0005});
  const auto traded = FoggyRun({0, 0.015, 0.007, 0.002, 0.0005});
  const metrics::PairedMetrics m = metrics::MeasurePair(baseline, traded, WithFloor(0.1));
  EXPECT_EQ(m.si_pct, 100);
  EXPECT_EQ(m.other_si_pct[PlaceOf("floor_20mm")], 100);
  EXPECT_NEAR(*m.other_si_pct[PlaceOf("floor_10mm")], 100.0 / 2, 1e-9);
  EXPECT_NEAR(*m.other_si_pct[PlaceOf("floor_5mm")], 100.0 / 3, 1e-9);
  EXPECT_NEAR(*m.other_si_pct[PlaceOf("floor_1mm")], 100.0 / 4, 1e-9);
  EXPECT_NEAR(*m.other_si_pct[PlaceOf("floor_0mm")], 100.0 / 5, 1e-9);
}

TEST(PairedMeasuresTest, HaveSafetyWithOtherReadingsOfCompromisedSafety) {
  // GIVEN fog from step 1 on, when the gap is 32 m and the safe distance 30 m
  auto baseline = QuietRun(3);
  for (const std::size_t k : {1, 2}) baseline[k].fog_present = true;
  for (metrics::Sample& sample : baseline) sample.follower_safe_distance_m = 30;
  auto traded = baseline;
  // WHEN the gap shrinks by 4 m and the safe distance by 1 m, but both shrink less with traded
  // control
  baseline[2].follower_gap_m = 28;
  traded[2].follower_gap_m = 30;
  baseline[2].follower_safe_distance_m = 29;
  traded[2].follower_safe_distance_m = 29.75;
  // THEN the definitions of compromised safety give different improvements: from 1 m to 0 m below
  // the safe distance, from 4 m to 2 m of lost gap, from 1 m to 0.25 m of lost safe distance
  const metrics::PairedMetrics m = metrics::MeasurePair(baseline, traded, WithFloor(0.1));
  EXPECT_EQ(m.si_pct, 100);
  EXPECT_EQ(m.other_si_pct[PlaceOf("gap_lost")], 50);
  EXPECT_EQ(m.other_si_pct[PlaceOf("safe_distance_lost")], 75);
}

TEST(PairedMeasuresTest, AreVisitedOnceEachWithTheirUnit) {
  std::set<std::string_view> names;
  metrics::VisitPairedMetrics({}, [&](std::string_view name, const std::optional<double>& value,
                                      std::string_view unit, std::string_view description) {
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_EQ(value, std::nullopt);
    EXPECT_EQ(unit, "%");
    EXPECT_TRUE(name.ends_with("_pct")) << name;
    EXPECT_FALSE(description.empty()) << name;
  });
  EXPECT_EQ(names.size(), 2U);
}

}  // namespace
}  // namespace fogline
