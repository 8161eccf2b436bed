#include "tools/report/metric_text.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(MetricTextTest, HasTheDigitsOfTheUnitAndAtMostFourSignificantOnes) {
  EXPECT_EQ(report::MetricText("min_host_gap_m", 36.43812, "m"), "36.44");
  EXPECT_EQ(report::MetricText("max_compromised_safety_m", 0.038773, "m"), "0.039");
  EXPECT_EQ(report::MetricText("min_host_ttc_s", 681.2345, "s"), "681.2");
  EXPECT_EQ(report::MetricText("human_time_s", 9.399999999999999, "s"), "9.40");
  EXPECT_EQ(report::MetricText("min_host_rss_margin_m", -12345.678, "m"), "-12346");
  EXPECT_EQ(report::MetricText("false_alarms_ph", 92.5449, "1/h"), "92.5");
}

TEST(MetricTextTest, HasPercentagesAsThePaperPrintsThem) {
  EXPECT_EQ(report::MetricText("si_pct", 100, "%"), "100.00");
  EXPECT_EQ(report::MetricText("si_pct", 80.796, "%"), "80.80");
  EXPECT_EQ(report::MetricText("si_pct", -1234.5678, "%"), "-1234.57");
}

TEST(MetricTextTest, CountsWithoutDecimals) {
  EXPECT_EQ(report::MetricText("steps", 500, ""), "500");
  EXPECT_EQ(report::MetricText("steps", 123456, ""), "123456");
  EXPECT_EQ(report::MetricText("max_doc", 0.83500, ""), "0.835");
}

TEST(MetricTextTest, TellsNothingFromNextToNothing) {
  EXPECT_EQ(report::MetricText("transfers_pmin", 0, "1/min"), "0");
  EXPECT_EQ(report::MetricText("max_compromised_safety_m", -0.0, "m"), "0");
  EXPECT_EQ(report::MetricText("max_compromised_safety_m", 0.000002, "m"), "< 0.001");
  EXPECT_EQ(report::MetricText("min_host_rss_margin_m", -0.000002, "m"), "> -0.001");
  EXPECT_EQ(report::MetricText("max_compromised_safety_m", 0.0005, "m"), "0.001");
}

TEST(MetricTextTest, HasNoTimeToCollisionBeyondMeaning) {
  EXPECT_EQ(report::MetricText("min_follower_ttc_s", 30946809.1, "s"), "> 1000");
  EXPECT_EQ(report::MetricText("min_ttc_s", 1000.1, "s"), "> 1000");
  EXPECT_EQ(report::MetricText("min_host_ttc_s", 1000, "s"), "1000");
  EXPECT_EQ(report::MetricText("duration_s", 30946809.1, "s"), "30946809");
}

}  // namespace
}  // namespace fogline
