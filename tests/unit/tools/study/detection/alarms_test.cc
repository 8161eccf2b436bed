#include "tools/study/detection/alarms.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "common/random.h"

namespace fogline {
namespace {

// A run of 100 s. Each record has a score, and the time at which the run first reaches this score.
study::ClearRun RunOf(study::ScoreRecords records) {
  return {.records = std::move(records), .scores = {}, .duration_s = 100};
}

TEST(AlarmCountTest, EachRunEndsAtItsFirstAlarm) {
  const std::vector runs{RunOf({{0, 0}, {2, 10}, {5, 60}}), RunOf({{1, 0}, {3, 30}})};
  const study::AlarmCount high = study::CountAlarms(runs, 4);
  EXPECT_EQ(high.alarms, 1);
  EXPECT_EQ(high.time_s, 60 + 100);
  const study::AlarmCount low = study::CountAlarms(runs, 2);
  EXPECT_EQ(low.alarms, 2);
  EXPECT_EQ(low.time_s, 10 + 30);
  EXPECT_EQ(low.ArlZero_s(), 20);
}

TEST(AlarmCountTest, BoundsAreThoseOfAPoissonCount) {
  // Tables of Garwood's bounds: 4.795 to 18.390 for 10 events, and at most 3.689 for no event.
  const auto [low, high] = study::AlarmCount{.alarms = 10, .time_s = 1000}.ArlZeroBounds_s();
  EXPECT_NEAR(low, 1000 / 18.390, 0.01);
  EXPECT_NEAR(high, 1000 / 4.7954, 0.01);
  const study::AlarmCount none{.alarms = 0, .time_s = 1000};
  EXPECT_TRUE(std::isinf(none.ArlZero_s()));
  EXPECT_NEAR(none.ArlZeroBounds_s().first, 1000 / 3.6889, 0.01);
  EXPECT_TRUE(std::isinf(none.ArlZeroBounds_s().second));
}

TEST(ThresholdFinderTest, IsTheLeastThatIsQuietEnough) {
  std::vector<study::ClearRun> runs;
  for (int i = 1; i <= 10; ++i) runs.push_back(RunOf({{0, 0}, {static_cast<double>(i), 50}}));
  // If the threshold is above k and at most k + 1, then 10 - k runs give an alarm after 50 s, and k
  // runs last 100 s without an alarm. ARL0, the total time divided by the number of alarms, is
  // 50 + 100 k/(10 - k) s.
  const double threshold = study::ThresholdFinder(runs).Threshold(280);
  EXPECT_GT(threshold, 7);
  EXPECT_LE(threshold, 8);
  EXPECT_GE(study::CountAlarms(runs, threshold).ArlZero_s(), 280);
  EXPECT_LT(study::CountAlarms(runs, std::nextafter(7.0, 0.0)).ArlZero_s(), 280);
}

TEST(ThresholdFinderTest, TakesAMeanTimeThatIsExactlyLongEnough) {
  std::vector<study::ClearRun> runs;
  for (int i = 1; i <= 10; ++i) runs.push_back(RunOf({{0, 0}, {static_cast<double>(i), 50}}));
  // With a threshold above 5, ARL0 is 50 + 100 * 5/5 = 150 s.
  const double threshold = study::ThresholdFinder(runs).Threshold(150);
  EXPECT_GT(threshold, 5);
  EXPECT_LE(threshold, 6);
  EXPECT_EQ(study::CountAlarms(runs, threshold).ArlZero_s(), 150);
}

TEST(ThresholdFinderTest, IsAboveAllScoresWhereTheGreatestComesTooOften) {
  const std::vector runs(5, RunOf({{0, 0}, {1, 2}}));
  const double threshold = study::ThresholdFinder(runs).Threshold(600);
  EXPECT_GT(threshold, 1);
  EXPECT_EQ(study::CountAlarms(runs, threshold).alarms, 0);
}

TEST(ThresholdFinderTest, CountsARunAsOftenAsItsWeightSays) {
  const std::vector runs{RunOf({{0, 0}, {1, 10}}), RunOf({{0, 0}, {2, 50}}),
                         RunOf({{0, 0}, {3, 40}})};
  const study::ThresholdFinder finder(runs);
  const std::vector doubled{runs[0], runs[1], runs[1]};
  for (const double arl_s : {20.0, 60.0, 90.0, 130.0, 400.0}) {
    EXPECT_EQ(finder.Threshold(std::vector{1.0, 2.0, 0.0}, arl_s),
              study::ThresholdFinder(doubled).Threshold(arl_s))
        << arl_s;
  }
}

TEST(ThresholdFinderTest, AgreesWithCountingAlarmsAtEveryThreshold) {
  std::vector<study::ClearRun> runs;
  const Random random(3, Stream{1'000'003});
  for (std::uint32_t i = 0; i < 30; ++i) {
    study::ClearRun& run = runs.emplace_back(study::ClearRun{.duration_s = 100});
    for (int step = 0; step < 100; ++step) {
      // Scores in tenths, so that many scores are equal.
      study::AddScore(std::floor(10 * random.Uniform2(step, i)[0] * step) / 10, step, run.records);
    }
  }
  for (const double arl_s : {5.0, 50.0, 80.0, 150.0, 400.0}) {
    const double threshold = study::ThresholdFinder(runs).Threshold(arl_s);
    EXPECT_GE(study::CountAlarms(runs, threshold).ArlZero_s(), arl_s);
    const double below = std::nextafter(threshold, -1.0);
    EXPECT_LT(study::CountAlarms(runs, below).ArlZero_s(), arl_s);
  }
}

TEST(AreaUnderRocTest, IsTheShareOfPairsInOrderTiesCountedHalf) {
  const std::array clear{1.0, 2.0, 3.0, 4.0};
  EXPECT_EQ(study::AreaUnderRoc(std::array{5.0, 6.0}, clear), 1);
  EXPECT_EQ(study::AreaUnderRoc(std::array{0.0}, clear), 0);
  EXPECT_EQ(study::AreaUnderRoc(std::array{2.0}, clear), 1.5 / 4);
  EXPECT_EQ(study::AreaUnderRoc(clear, clear), 0.5);
}

TEST(TruePositivesTest, TakesTheThresholdFromTheQuantileOfClearAir) {
  const std::array clear{1.0, 2.0, 3.0, 4.0};
  const std::array fog{0.5, 2.5, 3.5, 4.5};
  EXPECT_EQ(study::TruePositives(fog, clear, 0), 0.25);
  EXPECT_EQ(study::TruePositives(fog, clear, 0.25), 0.5);
  EXPECT_EQ(study::TruePositives(fog, clear, 0.5), 0.75);
  EXPECT_EQ(study::TruePositives(fog, clear, 1), 1);
}

TEST(TruePositivesTest, EqualScoresInClearAirDoNotHideFalsePositives) {
  // Half of the scores in clear air are 1. With a threshold up to 1, more than 10 % of the scores
  // are false positives. So the threshold is above 1.
  const std::array clear{0.0, 0.0, 1.0, 1.0};
  EXPECT_EQ(study::TruePositives(std::array{1.0, 2.0}, clear, 0.1), 0.5);
}

}  // namespace
}  // namespace fogline
