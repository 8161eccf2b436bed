#include "services/metrics/gaps/gap_rules.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "services/metrics/run_metrics.h"

namespace fogline::metrics {
namespace {

Lack Lacking(std::size_t channel) {
  Lack lack;
  lack.channels.set(channel);
  return lack;
}

/// The measures of a run that are unknown.
std::set<std::string> Unknown(const Lack& lack) {
  std::set<std::string> names;
  VisitMetrics({}, [&](std::string_view name, const auto&, std::string_view, std::string_view) {
    if (!IsKnown(name, lack)) names.emplace(name);
  });
  return names;
}

TEST(GapRulesTest, AllMeasuresOfACompleteLogAreKnown) {
  EXPECT_TRUE(Unknown({}).empty());
  EXPECT_TRUE(AreTakeOversKnown({}));
}

TEST(GapRulesTest, AMissingRadarMessageMakesNoMeasureUnknown) {
  EXPECT_TRUE(Unknown(Lacking(IndexOf<radar_t>())).empty());
}

TEST(GapRulesTest, AMissingTrackMakesTheMeasuresOfWrongTracksUnknown) {
  EXPECT_EQ(
      Unknown(Lacking(IndexOf<track_t>())),
      (std::set<std::string>{"max_compromised_safety_until_recovery_m",
                             "mean_compromised_safety_until_recovery_m", "wrong_automation_s"}));
  EXPECT_FALSE(AreTakeOversKnown(Lacking(IndexOf<track_t>())));
}

TEST(GapRulesTest, AMissingCommandMakesCountsAndTimesUnknownButNoExtremes) {
  const std::set<std::string> unknown = Unknown(Lacking(IndexOf<arbitration_t>()));
  for (const char* name : {"rhe_pct", "human_time_s", "transfers", "minimal_risk_s"}) {
    EXPECT_TRUE(unknown.contains(name)) << name;
  }
  for (const char* name : {"min_host_gap_m", "max_doc", "collision", "rms_jerk_mps3"}) {
    EXPECT_FALSE(unknown.contains(name)) << name;
  }
}

TEST(GapRulesTest, AMissingBeginningMakesOnlyUnknownWhatBeginsThere) {
  Lack late;
  late.beginning = true;
  EXPECT_EQ(Unknown(late), (std::set<std::string>{"deception_to_alarm_s", "max_slow_down_fog_mps",
                                                  "max_compromised_safety_until_recovery_m",
                                                  "mean_compromised_safety_until_recovery_m"}));
  EXPECT_TRUE(AreTakeOversKnown(late));
}

}  // namespace
}  // namespace fogline::metrics
