#include "tools/study/detection/conflict_intervals.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/random.h"

namespace fogline {
namespace {

constexpr double kArlZero_s = 400;
constexpr double kMissed_s = 11;
constexpr std::size_t kSeeds = 60;

/// The settings with which the tests compare detectors.
/// @param ranked indices of the visibilities whose delays are averaged
/// @param reference detector whose delay is subtracted from each delay
study::DetectionRule RuleOf(std::vector<std::size_t> ranked,
                            std::optional<std::size_t> reference = {}) {
  return {.arl_zero_s = kArlZero_s,
          .missed_s = kMissed_s,
          .ranked = std::move(ranked),
          .reference = reference,
          .jobs = 2};
}

/// Runs of 100 s. Each run reaches its greatest score at 50 s. These scores are uniform in (0, 1).
std::vector<study::ClearRun> ClearAir() {
  std::vector<study::ClearRun> runs;
  const Random random(1, Stream{1'000'004});
  for (std::uint32_t i = 0; i < kSeeds; ++i) {
    runs.push_back({.records = {{0, 0}, {random.Uniform2(0, i)[0], 50}}, .duration_s = 100});
  }
  return runs;
}

/// Fog in which the score grows by `slope` in each second. The scores are the same for every seed.
std::vector<study::ScoreRecords> Fog(double slope) {
  study::ScoreRecords records;
  for (int i = 0; i <= 1000; ++i) records.push_back({slope * 0.01 * i, 0.01 * i});
  return std::vector(kSeeds, records);
}

TEST(CompareDetectionTest, HasTheUncertaintyOfTheThresholdInItsIntervals) {
  const std::vector<study::ClearRun> clear = ClearAir();
  const std::vector<std::vector<study::ScoreRecords>> fog{Fog(0.1)};
  const std::array runs{study::DetectorRuns{.clear = clear, .fog = fog}};
  const auto compared = study::CompareDetection(runs, RuleOf({0}));
  const study::Estimate& delay = compared[0].detector.by_visibility[0].delay_s;
  const double threshold = study::ThresholdFinder(clear).Threshold(kArlZero_s);
  EXPECT_NEAR(delay.mean, threshold / 0.1, 0.011);
  // All runs in fog are equal, so only the threshold can vary. A run in clear air lasts 50 s if it
  // has an alarm, else 100 s. If a share q of these 60 runs has an alarm, the mean time to a false
  // alarm (ARL0) is (100 - 50 q)/q s. ARL0 is 400 s, so q is 2/9. The threshold is a quantile of
  // the greatest scores: the scores of a share q of the runs exceed it. Its standard deviation is
  // sqrt(q (1 - q)/60). The score in fog grows by 0.1 in a second, so the delay is the threshold
  // divided by 0.1.
  const double deviation_s = std::sqrt(2.0 / 9 * 7.0 / 9 / kSeeds) / 0.1;
  // The ends of the interval are two of the 60 scores, in order of their size. They are
  // 2 * 1.96 * sqrt(60 q (1 - q)) = 12.6 places apart. A sum of this many spacings has a relative
  // standard deviation of 28 %, because the standard deviation of a spacing equals its mean.
  const double width_s = 2 * 1.96 * deviation_s;
  EXPECT_NEAR(delay.high - delay.low, width_s, 2 * 0.28 * width_s);
  EXPECT_FALSE(compared[0].delay_minus_other_s[0].has_interval()) << "there is no other";
}

TEST(CompareDetectionTest, PairsMeasuresAndVisibilitiesByRun) {
  const std::vector<study::ClearRun> clear = ClearAir();
  const std::vector<std::vector<study::ScoreRecords>> slow{Fog(0.1), Fog(0.2)};
  const std::vector<std::vector<study::ScoreRecords>> fast{Fog(0.2), Fog(0.4)};
  const std::array runs{study::DetectorRuns{.clear = clear, .fog = slow},
                        study::DetectorRuns{.clear = clear, .fog = fast},
                        study::DetectorRuns{.clear = clear, .fog = slow}};
  const auto compared = study::CompareDetection(runs, RuleOf({0, 1}, 0));
  // compared[2] is the same measure as compared[0]. Both have the same threshold in every sample of
  // the bootstrap.
  const study::Estimate again = study::DelayDifference(compared[2], compared[0]);
  EXPECT_EQ(again.low, 0);
  EXPECT_EQ(again.high, 0);
  const study::Estimate faster = study::DelayDifference(compared[1], compared[0]);
  EXPECT_EQ(study::VerdictOf(faster), study::Verdict::kLess);
  EXPECT_NEAR(faster.mean, compared[1].detector.delay_s.mean - compared[0].detector.delay_s.mean,
              1e-12);
  EXPECT_NEAR(compared[1].delay_minus_other_s[0].mean,
              -compared[1].detector.by_visibility[0].delay_s.mean, 0.021);
  EXPECT_NEAR(compared[0].detector.delay_s.mean,
              (compared[0].detector.by_visibility[0].delay_s.mean +
               compared[0].detector.by_visibility[1].delay_s.mean) /
                  2,
              1e-12);
}

TEST(CompareDetectionTest, AveragesTheRankedVisibilitiesOnly) {
  const std::vector<study::ClearRun> clear = ClearAir();
  const std::vector<std::vector<study::ScoreRecords>> fog{Fog(0.1), Fog(0.2), Fog(0.4)};
  const std::array runs{study::DetectorRuns{.clear = clear, .fog = fog}};
  const auto second = study::CompareDetection(runs, RuleOf({1}));
  EXPECT_EQ(second[0].detector.delay_s.mean, second[0].detector.by_visibility[1].delay_s.mean);
  EXPECT_EQ(second[0].detector.delay_s.low, second[0].detector.by_visibility[1].delay_s.low);
  const auto none = study::CompareDetection(runs, RuleOf({}));
  EXPECT_TRUE(std::isnan(none[0].detector.delay_s.mean));
  EXPECT_FALSE(none[0].detector.delay_s.has_interval());
  EXPECT_TRUE(none[0].detector.by_visibility[1].delay_s.has_interval());
}

TEST(CompareDetectionTest, DetectorsMayHaveDifferentlyManyRunsInClearAir) {
  const std::vector<study::ClearRun> clear = ClearAir();
  std::vector<study::ClearRun> more;
  for (int i = 0; i < 20; ++i) more.insert(more.end(), clear.begin(), clear.end());
  const std::vector<std::vector<study::ScoreRecords>> fog{Fog(0.1)};
  const std::array runs{study::DetectorRuns{.clear = clear, .fog = fog},
                        study::DetectorRuns{.clear = more, .fog = fog}};
  const auto compared = study::CompareDetection(runs, RuleOf({0}));
  const study::Estimate& few = compared[0].detector.delay_s;
  const study::Estimate& many = compared[1].detector.delay_s;
  // `more` has each run of `clear` twenty times. So both detectors have the same threshold and the
  // same mean delay. But with more runs the threshold is more certain, so the interval of the delay
  // is narrower.
  EXPECT_EQ(many.mean, few.mean);
  EXPECT_LT(many.high - many.low, (few.high - few.low) / 2);
}

TEST(CompareDetectionTest, ACertainDetectionHasTheIntervalOfClopperAndPearson) {
  const std::vector<study::ClearRun> clear = ClearAir();
  const std::vector<std::vector<study::ScoreRecords>> fog{Fog(1), Fog(0)};
  const std::array runs{study::DetectorRuns{.clear = clear, .fog = fog}};
  const auto compared = study::CompareDetection(runs, RuleOf({0, 1}));
  const study::Estimate& all = compared[0].detector.by_visibility[0].detection;
  const study::Estimate& none = compared[0].detector.by_visibility[1].detection;
  EXPECT_EQ(all.mean, 1);
  EXPECT_NEAR(all.low, std::pow(0.025, 1.0 / kSeeds), 1e-9);
  EXPECT_EQ(all.high, 1);
  EXPECT_EQ(none.mean, 0);
  EXPECT_NEAR(none.high, 1 - std::pow(0.025, 1.0 / kSeeds), 1e-9);
  EXPECT_EQ(compared[0].detector.by_visibility[1].delay_s.mean, kMissed_s);
}

}  // namespace
}  // namespace fogline
