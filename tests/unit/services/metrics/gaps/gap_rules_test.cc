#include "services/metrics/gaps/gap_rules.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>

#include "services/metrics/run_metrics.h"

namespace fogline::metrics {
namespace {

/// One message of this channel is missing.
Lack Lacking(std::size_t channel) {
  Lack lack;
  lack.channels.set(channel);
  return lack;
}

/// All messages of this channel are missing.
Lack LackingEvery(std::size_t channel) {
  Lack lack = Lacking(channel);
  lack.every.set(channel);
  return lack;
}

/// The names of the measures that are unknown if a log lacks the messages that `lack` names.
/// @param has_value whether each measure has a value
std::set<std::string> Unknown(const Lack& lack, bool has_value = true) {
  std::set<std::string> names;
  VisitMetrics({}, [&](std::string_view name, const auto&, std::string_view, std::string_view) {
    if (!IsKnown(name, has_value, lack)) names.emplace(name);
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

TEST(GapRulesTest, EachMeasureHasARule) {
  EXPECT_TRUE(Unknown(LackingEvery(IndexOf<radar_t>())).empty());
}

TEST(GapRulesTest, ExtremesAndMeansOfAChannelWithoutAnyMessageAreUnknown) {
  const auto more = [](std::size_t channel) {
    std::set<std::string> names = Unknown(LackingEvery(channel));
    for (const std::string& name : Unknown(Lacking(channel))) names.erase(name);
    return names;
  };
  EXPECT_EQ(more(IndexOf<arbitration_t>()),
            (std::set<std::string>{"max_doc", "min_conflict_clear_m", "max_conflict_clear_m"}));
  EXPECT_EQ(more(IndexOf<track_t>()), (std::set<std::string>{"rms_fusion_error_m"}));
  EXPECT_EQ(more(IndexOf<follower_command_t>()),
            (std::set<std::string>{"max_compromised_safety_m", "mean_compromised_safety_fog_m"}));
  EXPECT_FALSE(AreTakeOversKnown(LackingEvery(IndexOf<arbitration_t>())));
}

TEST(GapRulesTest, NothingIsKnownWithoutTruth) {
  std::set<std::string> all;
  VisitMetrics({}, [&](std::string_view name, const auto&, std::string_view, std::string_view) {
    all.emplace(name);
  });
  EXPECT_EQ(Unknown(LackingEvery(IndexOf<truth_t>())), all);
}

TEST(GapRulesTest, AMissingTruthMakesSumsAndDifferencesUnknown) {
  const std::set<std::string> unknown = Unknown(Lacking(IndexOf<truth_t>()));
  for (const char* name :
       {"host_tet_s", "host_tit_s2", "host_cpi", "follower_tet_s", "follower_tit_s2",
        "follower_cpi", "max_abs_jerk_mps3", "max_abs_jerk_1s_mps3", "rms_jerk_mps3",
        "max_slow_down_fog_mps", "transfers", "false_alarms_ph"}) {
    EXPECT_TRUE(unknown.contains(name)) << name;
  }
  for (const char* name : {"min_host_gap_m", "min_host_ttc_s", "collision", "collision_time_s",
                           "max_abs_acceleration_mps2", "rms_fusion_error_m", "steps"}) {
    EXPECT_FALSE(unknown.contains(name)) << name;
  }
}

TEST(GapRulesTest, AMissingScanMakesTheMeasuresOfDeceptionUnknown) {
  EXPECT_EQ(Unknown(Lacking(IndexOf<lidar_t>())),
            (std::set<std::string>{"wrong_human_s", "deception_to_alarm_s", "false_alarms_ph"}));
}

TEST(GapRulesTest, AnExtremeWithoutAValueIsUnknownIfAMissingStepMightGiveOne) {
  const std::set<std::string> radar = Unknown(Lacking(IndexOf<radar_t>()), false);
  EXPECT_TRUE(radar.empty());
  const std::set<std::string> follower = Unknown(Lacking(IndexOf<follower_command_t>()), false);
  EXPECT_TRUE(follower.contains("mean_compromised_safety_fog_m"));
  EXPECT_FALSE(follower.contains("min_host_ttc_s"));
  Lack late;
  late.beginning = true;
  EXPECT_TRUE(Unknown(late, false).contains("mean_compromised_safety_fog_m"));
  EXPECT_FALSE(Unknown(late, false).contains("collision_time_s"));
}

TEST(GapRulesTest, ACollisionThatOnlyTheLastTruthWouldShowIsUnknown) {
  Lack lack = Lacking(IndexOf<truth_t>());
  EXPECT_TRUE(IsKnown("collision", std::int64_t{0}, lack));
  lack.last = true;
  EXPECT_FALSE(IsKnown("collision", std::int64_t{0}, lack));
  EXPECT_TRUE(IsKnown("collision", std::int64_t{1}, lack));
}

TEST(GapRulesTest, AMissingBeginningMakesOnlyUnknownWhatBeginsThere) {
  Lack late;
  late.beginning = true;
  EXPECT_EQ(Unknown(late), (std::set<std::string>{"deception_to_alarm_s", "max_slow_down_fog_mps",
                                                  "max_compromised_safety_until_recovery_m",
                                                  "mean_compromised_safety_until_recovery_m"}));
  EXPECT_TRUE(AreTakeOversKnown(late));
}

TEST(GapRulesTest, AllTakeOversAreKnownOnlyIfNoneCanBeOutsideOfTheLog) {
  EXPECT_TRUE(AreAllTakeOversKnown({}));
  EXPECT_FALSE(AreAllTakeOversKnown(Lacking(IndexOf<track_t>())));
  for (bool Lack::*const part : {&Lack::beginning, &Lack::beginning_of_request, &Lack::end}) {
    Lack lack;
    lack.*part = true;
    EXPECT_FALSE(AreAllTakeOversKnown(lack));
    EXPECT_TRUE(AreTakeOversKnown(lack));
  }
}

}  // namespace
}  // namespace fogline::metrics
