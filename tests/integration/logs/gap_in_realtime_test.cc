// Runs in real time whose logs lack published messages. In real time a role may skip a step, so it
// is normal that some messages were never published.
#include <cstdint>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/logs/gap_fixture.h"

namespace fogline::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

/// The runs of this test have 250 steps. The last steps are in fog.
class GapInRealtimeTest : public GapTest {
 protected:
  /// Makes a run. @return its log
  std::string Run(const std::string& policy) {
    whole_ = folder_.File(policy + ".lcm");
    const Outcome run =
        Fogline({"run", "scenario/paper.json", "--realtime", "--speed", "20", "--quiet", "--force",
                 "--log", whole_, "--set", "/steps=250", "--set", "/arbitrator/policy=" + policy});
    EXPECT_EQ(run.code, 0) << run.err;
    return whole_;
  }
};

TEST_F(GapInRealtimeTest, PairsHaveNoSafetyImprovementIfALogLacksATruth) {
  const auto without_one = [&](const std::string& policy) {
    Run(policy);
    return Without(
        [](std::string_view channel, std::int64_t step) { return channel == "TRUTH" && step == 7; },
        policy + "_gap.lcm");
  };
  const std::string none = without_one("none");
  const std::string traded = without_one("traded");
  const nlohmann::json pair = Json({"metrics", none, traded}, 1);
  EXPECT_TRUE(pair[1]["si_pct"].is_null());
  EXPECT_LE(pair[1]["metrics"]["steps"], 249);
  EXPECT_THAT(Fogline({"metrics", none, traded}).err,
              HasSubstr(", si_pct, si_until_recovery_pct; the other measures are of the steps"));
}

TEST_F(GapInRealtimeTest, MeasuresAreUnknownIfPublishedMessagesOfTheirChannelsAreMissing) {
  // The test needs a run whose second event is its first transfer. On a busy machine roles skip
  // steps, so a run may have other events before its first transfer. Then the test makes another
  // run.
  constexpr int kTries = 10;
  constexpr int kBefore = 60;
  std::string whole;
  std::int64_t transfer = 0;
  for (int i = 0; i < kTries && transfer <= kBefore; ++i) {
    whole = Run("traded");
    const nlohmann::json of_whole = Json({"events", whole}, 0)[0]["events"];
    if (of_whole.size() < 2 || !of_whole[1].value("transfer", false)) continue;
    transfer = of_whole[1]["step"];
  }
  ASSERT_GT(transfer, kBefore);
  EXPECT_THAT(Fogline({"metrics", whole}).err, Not(HasSubstr("unknown")));
  const std::string log = Without([&](std::string_view channel, std::int64_t step) {
    return channel == "HOST_COMMAND" && step >= transfer - kBefore && step <= transfer;
  });
  const nlohmann::json metrics = Json({"metrics", log}, 1)[0]["metrics"];
  EXPECT_TRUE(metrics["human_time_s"].is_null());
  EXPECT_FALSE(metrics["min_host_gap_m"].is_null());
  EXPECT_THAT(
      Fogline({"metrics", log}).err,
      ContainsRegex("published, but not in the log: at least [0-9]+ [(][A-Z_, ]*HOST_COMMAND"));
  const nlohmann::json event = Json({"events", log}, 1)[0]["events"].at(1);
  EXPECT_LE(event["earliest_step"], transfer - kBefore)
      << "a step before the gap may have no command";
  EXPECT_GT(event["step"], transfer);
  EXPECT_THAT(
      Fogline({"events", log}).out,
      ContainsRegex("unknown: the log may lack published messages of [A-Z_, ]*HOST_COMMAND"));
  // The story at the top of a report says nothing about a run with unknown measures.
  const std::string page = folder_.File("report.html");
  EXPECT_EQ(Fogline({"report", whole, "--output", page}).code, 0);
  EXPECT_THAT(Content(page), HasSubstr("the human drove for "));
  EXPECT_EQ(Fogline({"report", log, "--output", page}).code, 1);
  EXPECT_THAT(Content(page), Not(HasSubstr("the human drove for ")));
}

TEST_F(GapInRealtimeTest, OneLostCommandIsFoundAlthoughLaterStepsHaveNoStatus) {
  Run("traded");
  const std::string log = Without([](std::string_view channel, std::int64_t step) {
    return channel == "HOST_COMMAND" && step == 100;
  });
  const nlohmann::json metrics = Json({"metrics", log}, 1)[0];
  EXPECT_EQ(metrics["complete"], false);
  EXPECT_TRUE(metrics["metrics"]["human_time_s"].is_null());
  EXPECT_THAT(metrics["unknown_measures"], ::testing::Contains("human_time_s"));
  EXPECT_THAT(
      Fogline({"metrics", log}).err,
      ContainsRegex("published, but not in the log: at least [0-9]+ [(][A-Z_, ]*HOST_COMM"));
}

TEST_F(GapInRealtimeTest, FiguresAreUnknownWithoutStatus) {
  Run("traded");
  const std::string log = Without([](std::string_view channel, std::int64_t step) {
    return channel == "STATUS" || (channel == "HOST_COMMAND" && step > 100 && step < 120);
  });
  const nlohmann::json metrics = Json({"metrics", log}, 1)[0];
  EXPECT_EQ(metrics["complete"], false);
  EXPECT_EQ(metrics["realtime"]["ticks"], nullptr);
  EXPECT_EQ(metrics["realtime"]["speed"], 20);
  EXPECT_EQ(metrics["metrics"]["human_time_s"], nullptr);
  const Outcome text = Fogline({"metrics", log});
  EXPECT_THAT(text.err, HasSubstr("real time, without STATUS of the world"));
  EXPECT_THAT(text.out, HasSubstr("  latency_p50_us                       unknown\n"));
}

TEST_F(GapInRealtimeTest, SaysWithWhichStepALateLogBegins) {
  // The test needs a run in which no role skips a step. If roles skip steps on a busy machine, the
  // test makes another run.
  bool is_whole = false;
  for (int attempt = 0; attempt < 5 && !is_whole; ++attempt) {
    is_whole = Json({"metrics", Run("traded")}, 0)[0]["realtime"]["missed_messages"] == 0;
  }
  ASSERT_TRUE(is_whole);
  const std::string log = Without([](std::string_view channel, std::int64_t step) {
    return channel != "RUN" && channel != "STATUS" && step < 100;
  });
  EXPECT_THAT(Fogline({"metrics", log}).err, HasSubstr("begins at step 100 of 250; real time, "));
  EXPECT_FALSE(Json({"metrics", log}, 1)[0]["metrics"]["human_time_s"].is_null());
}

}  // namespace
}  // namespace fogline::test
