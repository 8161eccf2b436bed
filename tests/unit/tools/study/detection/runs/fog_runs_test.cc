// Runs of detectors in clear air and in fog.
#include "tools/study/detection/runs/fog_runs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "tests/unit/tools/study/few_seeds.h"
#include "tools/study/detection/detector_bank.h"

namespace fogline {
namespace {

constexpr double kStep_s = 0.1;

/// Traffic in which the human always drives, with fog (or none) from the end of the warm-up on.
study::Traffic ShortTraffic(double after_s, double fog_s) {
  Scenario scenario = LoadScenario(
      test::SourceDirectory() / "scenario/paper.json",
      {"/arbitrator/policy=traded", "/arbitrator/threshold=0", "/arbitrator/missing_lidar=conflict",
       "/fog/start_s=" + std::to_string(study::kWarmUp_s),
       "/fog/duration_s=" + std::to_string(fog_s), "/radar/range_std_m=0.1"});
  scenario.steps = std::llround((study::kWarmUp_s + after_s) / kStep_s) + 1;
  return study::TrafficOf(scenario);
}

const std::vector<std::size_t> kDistance{study::DetectorNamed("doc")};

TEST(ClearAirTest, BeginsAfterTheWarmUp) {
  const study::StudyContext context = test::FewSeeds(1, 3);
  const auto runs = study::RunClearAir(
      context, ShortTraffic(4, 0),
      {.detectors = kDistance, .first_seed = 5, .runs_per_seed = 2, .keeps_scores = true}, [] {});
  ASSERT_EQ(runs.size(), 1U);
  ASSERT_EQ(runs[0].size(), 6U) << "two runs for each of three seeds";
  for (const study::ClearRun& run : runs[0]) {
    EXPECT_NEAR(run.duration_s, 4, 1e-9);
    ASSERT_FALSE(run.records.empty());
    EXPECT_NEAR(run.records.front().time_s, 0, 1e-9) << "the first score is a record";
    EXPECT_EQ(run.scores.size(), 5U) << "every tenth of 41 steps";
  }
  EXPECT_NE(runs[0][0].scores, runs[0][1].scores) << "two runs of a seed differ";
}

TEST(RecordsInFogTest, CountTimeFromTheBeginningOfTheFog) {
  const auto records =
      study::RecordsInFog(test::FewSeeds(1, 3), ShortTraffic(4, 4), kDistance, [] {});
  ASSERT_EQ(records.size(), 1U);
  ASSERT_EQ(records[0].size(), 3U);
  for (const study::ScoreRecords& one : records[0]) {
    ASSERT_FALSE(one.empty());
    EXPECT_NEAR(one.front().time_s, 0, 1e-9);
    EXPECT_LE(one.back().time_s, 4);
  }
}

TEST(SortScoresTest, PutsTheRunsIntoBatchesInTurn) {
  std::vector<study::ClearRun> runs(23);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].scores = {static_cast<double>(i), -static_cast<double>(i)};
  }
  const std::array by_detector{runs};
  const std::vector<study::SortedBatches> sorted = study::SortScores(by_detector);
  ASSERT_EQ(sorted.size(), 1U);
  ASSERT_EQ(sorted[0].size(), static_cast<std::size_t>(study::kBatches));
  EXPECT_EQ(sorted[0][2], (std::vector<double>{-22, -12, -2, 2, 12, 22}));
  EXPECT_EQ(sorted[0][3], (std::vector<double>{-13, -3, 3, 13}));
}

TEST(RunInFogTest, ComparesEachSeedWithTheClearAirOfItsBatch) {
  // GIVEN clear air whose scores in batch 0 are below every score in fog, and in batch 1 above
  // every score in fog
  const std::size_t detectors = study::AllDetectors().size();
  const std::vector<study::SortedBatches> clear(detectors, {{-1e300}, {1e300}});
  const std::vector<study::Gathered> gathered =
      study::RunInFog(test::FewSeeds(1, 2), ShortTraffic(4, 4), clear, [] {});
  ASSERT_EQ(gathered.size(), detectors);
  for (const study::Gathered& one : gathered) {
    EXPECT_EQ(one.auc.Result(), (std::vector<double>{1, 0}));
    EXPECT_EQ(one.records.size(), 2U);
  }
}

}  // namespace
}  // namespace fogline
