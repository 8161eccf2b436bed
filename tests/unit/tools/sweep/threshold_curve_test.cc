#include "tools/sweep/threshold_curve.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/io/loader.h"

namespace fogline {
namespace {

using ::testing::ElementsAre;

/// The shipped experiment, up to some time after the beginning of the fog.
Scenario ShortScenario() {
  return LoadScenario(FOGLINE_SOURCE_DIR "/scenario/paper.json", {"/steps=220"});
}

std::vector<sweep::ThresholdRow> Sweep(const std::vector<double>& thresholds, int jobs) {
  return sweep::SweepThresholds(ShortScenario(), thresholds, {.first = 3, .last = 8}, jobs,
                                [](std::int64_t) { return true; });
}

TEST(SweepThresholdsTest, HasARowForEachThresholdInTheirOrderWithEverySeed) {
  const std::vector<sweep::ThresholdRow> rows = Sweep({0.9, 0.2, 0.5}, 2);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].threshold, 0.9);
  EXPECT_EQ(rows[1].threshold, 0.2);
  EXPECT_EQ(rows[2].threshold, 0.5);
  for (const sweep::ThresholdRow& row : rows) EXPECT_EQ(row.rhe_pct.Result().count, 6);
}

TEST(SweepThresholdsTest, DoesNotDependOnTheNumberOfThreadsByABit) {
  const std::vector<sweep::ThresholdRow> one = Sweep({0.3, 0.5}, 1);
  const std::vector<sweep::ThresholdRow> many = Sweep({0.3, 0.5}, 4);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].si_pct.Result().mean, many[i].si_pct.Result().mean);
    EXPECT_EQ(one[i].rhe_pct.Result().mean, many[i].rhe_pct.Result().mean);
    EXPECT_EQ(one[i].si_pct.Result().p95, many[i].si_pct.Result().p95);
  }
}

TEST(SweepThresholdsTest, EngagesTheHumanAlwaysAtZeroAndHasNoSafetyToGainAtOne) {
  // DoC is a logistic function, so it is above 0 and below 1. With threshold 0 the human always
  // drives, and with threshold 1 never.
  const std::vector<sweep::ThresholdRow> rows = Sweep({0, 1}, 2);
  EXPECT_EQ(rows[0].rhe_pct.Result().mean, 100.0);
  EXPECT_EQ(rows[1].rhe_pct.Result().mean, 0.0);
  EXPECT_EQ(rows[1].si_pct.Result().mean, 0.0);
}

TEST(SweepThresholdsTest, ReportsSeedsInOrderAndStopsWhenAsked) {
  std::vector<std::int64_t> done;
  sweep::SweepThresholds(ShortScenario(), std::vector{0.5}, {.first = 1, .last = 50}, 2,
                         [&](std::int64_t seeds) {
                           done.push_back(seeds);
                           return seeds < 3;
                         });
  EXPECT_THAT(done, ElementsAre(1, 2, 3));
}

}  // namespace
}  // namespace fogline
