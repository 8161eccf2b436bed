#include "tools/cli/measures/run_text.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

namespace fogline::test {
namespace {

using testing::HasSubstr;

runner::RunResult Measured() {
  runner::RunResult result;
  result.measures.steps = 500;
  result.measures.min_host_gap_m = 12.34567;
  result.followers.resize(1);
  return result;
}

TEST(MeasuresTest, AreAllInTheJsonWithAllTheirDigits) {
  const auto json = nlohmann::json::parse(cli::MetricsJson(Measured()));
  EXPECT_EQ(json["steps"], 500);
  EXPECT_EQ(json["min_host_gap_m"], 12.34567);
  EXPECT_TRUE(json["rhe_pct"].is_null());
  std::size_t measures = 0;
  metrics::VisitMetrics(metrics::RunMetrics(), [&](auto&&...) { ++measures; });
  EXPECT_EQ(json.size(), measures) << "no list of one following car";
}

TEST(MeasuresTest, AreALineEachForAPerson) {
  const std::string text = cli::MetricsText(Measured());
  EXPECT_THAT(text, HasSubstr("  min_host_gap_m                         12.35 m\n"));
  EXPECT_THAT(text, HasSubstr("  rhe_pct                                    - %\n"));
  EXPECT_EQ(text.find("follower  "), std::string::npos);
}

TEST(MeasuresTest, AreThoseOfEachCarOfAColumn) {
  runner::RunResult result = Measured();
  result.followers.resize(2);
  result.followers[1].min_gap_m = 3.25;
  const auto json = nlohmann::json::parse(cli::MetricsJson(result));
  ASSERT_EQ(json["followers"].size(), 2U);
  EXPECT_TRUE(json["followers"][0]["min_gap_m"].is_null());
  EXPECT_EQ(json["followers"][1]["min_gap_m"], 3.25);
  const std::string text = cli::MetricsText(result);
  EXPECT_THAT(text, HasSubstr("\n  follower    min_gap_m  min_ttc_s  "));
  EXPECT_THAT(text, HasSubstr("\n  2               3.250          -  "));
}

TEST(MeasuresTest, OfARunInRealTimeAreItsFiguresAndFallbacks) {
  log::RealtimeFigures figures;
  figures.has_status = true;
  figures.ticks_late = 4;
  figures.fallbacks = {
      {.step = 17, .role = "arbitrator", .what = "TRACK lost", .culprit = "fusion"},
      {.step = 18, .role = "world", .what = "HOST_COMMAND lost"}};
  figures.fallbacks_left_out = 3;
  const auto json = cli::RealtimeJson(figures);
  EXPECT_EQ(json["ticks_late"], 4);
  EXPECT_EQ(json["fallbacks"][0].dump(),
            R"({"step":17,"role":"arbitrator","what":"TRACK lost","culprit":"fusion"})");
  EXPECT_TRUE(json["fallbacks"][1]["culprit"].is_null());
  EXPECT_EQ(json["fallbacks_left_out"], 3);

  const std::string text = cli::RealtimeText(figures);
  EXPECT_THAT(text, HasSubstr("  ticks_late                                 4 \n"));
  EXPECT_THAT(text, HasSubstr("  " + figures.fallbacks[0].Text() + "\n"));
  EXPECT_THAT(text, testing::EndsWith("  ... and 3 more\n"));
}

}  // namespace
}  // namespace fogline::test
