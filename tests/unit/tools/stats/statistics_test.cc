#include "tools/stats/statistics.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace fogline {
namespace {

stats::Summary SummaryOf(const std::vector<double>& values) {
  stats::Statistics statistics;
  for (const double value : values) statistics.Add(value);
  return statistics.Result();
}

TEST(StatisticsTest, SaysNothingOfNoValue) {
  const stats::Summary summary = SummaryOf({});
  EXPECT_EQ(summary.count, 0);
  EXPECT_FALSE(summary.mean.has_value());
  EXPECT_FALSE(summary.deviation.has_value());
}

TEST(StatisticsTest, KnowsTheMeanOfOneValueButNoSpread) {
  const stats::Summary summary = SummaryOf({80.79});
  EXPECT_EQ(summary.count, 1);
  EXPECT_EQ(summary.mean, 80.79);
  EXPECT_FALSE(summary.deviation.has_value());
  EXPECT_FALSE(summary.ci95.has_value());
  EXPECT_FALSE(summary.p5.has_value());
  EXPECT_FALSE(summary.p95.has_value());
}

TEST(StatisticsTest, HasNoSpreadWhereAllValuesAreEqual) {
  const stats::Summary summary = SummaryOf(std::vector<double>(200, 0.1));
  EXPECT_EQ(summary.mean, 0.1);
  EXPECT_EQ(summary.deviation, 0.0);
  EXPECT_EQ(summary.ci95, 0.0);
  EXPECT_EQ(summary.p5, 0.1);
  EXPECT_EQ(summary.p95, 0.1);
}

TEST(StatisticsTest, GivesTheDeviationOfASample) {
  // The mean is 5, the squared distances from it have the sum 32, and n - 1 is 7.
  const stats::Summary summary = SummaryOf({2, 4, 4, 4, 5, 5, 7, 9});
  EXPECT_DOUBLE_EQ(*summary.mean, 5.0);
  EXPECT_DOUBLE_EQ(*summary.deviation, std::sqrt(32.0 / 7.0));
}

TEST(StatisticsTest, TakesTheIntervalOfTheMeanFromStudentsT) {
  // Printed tables of t, two-sided 95 %: 12.706 for 1 degree of freedom, 2.262 for 9.
  EXPECT_NEAR(*SummaryOf({0, 2}).ci95, 12.706 * std::sqrt(2.0) / std::sqrt(2.0), 5e-4);
  const stats::Summary ten = SummaryOf({1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  EXPECT_NEAR(*ten.ci95, 2.262 * *ten.deviation / std::sqrt(10.0), 1e-3);
}

TEST(StatisticsTest, InterpolatesPercentilesWhateverTheOrderOfValues) {
  // The 5th percentile of 0, 1, ... 100 is 5. GIVEN these values in a mixed order (37 and 101 are
  // coprime)
  std::vector<double> values;
  for (int i = 0; i < 101; ++i) values.push_back(37 * i % 101);
  const stats::Summary summary = SummaryOf(values);
  EXPECT_DOUBLE_EQ(*summary.p5, 5.0);
  EXPECT_DOUBLE_EQ(*summary.p95, 95.0);
  // The percentiles of two values lie on the line between these values.
  EXPECT_DOUBLE_EQ(*SummaryOf({10, 0}).p5, 0.5);
  EXPECT_DOUBLE_EQ(*SummaryOf({10, 0}).p95, 9.5);
}

TEST(StatisticsTest, KeepsTheSpreadOfValuesFarFromZero) {
  // Plain sums of squares would lose all digits of the deviation, which is 1.
  EXPECT_DOUBLE_EQ(*SummaryOf({1e9 - 1, 1e9, 1e9 + 1}).deviation, 1.0);
}

}  // namespace
}  // namespace fogline
