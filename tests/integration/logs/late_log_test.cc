// Requests to take over in a log that lacks the beginning of its run.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/logs/gap_fixture.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The run has one request, in the fog.
class LateLogTest : public GapTest {
 protected:
  LateLogTest() : GapTest("/arbitrator/take_over/mode=requested") {
    events_ = Json({"events", whole_}, 0)[0]["events"];
    request_ = Json({"events", whole_}, 0)[0]["requests"].at(0);
    measures_ = Json({"metrics", whole_}, 0)[0]["take_overs"].at(0);
    EXPECT_EQ(events_.at(1)["to"], "DEMAND");
    asked_ = events_.at(1)["step"];
  }

  std::string From(std::int64_t first) const {
    return Without([&](std::string_view channel, std::int64_t step) {
      return channel != "RUN" && step < first;
    });
  }

  /// The events that `fogline events` must print for a log that begins with step `first`: one entry
  /// for this step, and all entries of the whole log after this step.
  nlohmann::json EventsFrom(std::int64_t first, const std::string& mode) const {
    auto events = nlohmann::json::array();
    events.push_back({{"step", first},
                      {"time_s", static_cast<double>(first) / 10},
                      {"event", "first command of the log"},
                      {"transfer", false},
                      {"from", mode},
                      {"to", mode}});
    std::ranges::copy_if(events_, std::back_inserter(events),
                         [&](const auto& event) { return event["step"] > first; });
    return events;
  }

  nlohmann::json events_;    // of the whole log
  nlohmann::json request_;   // of `fogline events`
  nlohmann::json measures_;  // of `fogline metrics`
  std::int64_t asked_ = 0;   // step of the request
};

TEST_F(LateLogTest, HasTheRequestsThatBeginInIt) {
  // GIVEN a log that begins before the fog
  const std::string log = From(asked_ - 20);
  const nlohmann::json events = Json({"events", log}, 1)[0];
  EXPECT_EQ(events["events"], EventsFrom(asked_ - 20, "AUTOMATED"));
  EXPECT_EQ(events["requests"], nlohmann::json::array({request_}));
  EXPECT_EQ(Json({"metrics", log}, 1)[0]["take_overs"], nlohmann::json::array({measures_}));
  for (const char* verb : {"events", "metrics"}) {
    EXPECT_THAT(Fogline({verb, log}).err, Not(HasSubstr("take-over"))) << verb;
  }
}

TEST_F(LateLogTest, DoesNotKnowTheBeginningOfTheFogThatItBeginsIn) {
  EXPECT_NEAR(measures_["speed_at_fog_mps"], 20, 0.1);
  const std::string log = From(asked_ - 2);
  nlohmann::json expected = measures_;
  expected["speed_at_fog_mps"] = nullptr;
  const nlohmann::json measured = Json({"metrics", log}, 1)[0]["take_overs"];
  ASSERT_EQ(measured.size(), 1U);
  // The jerk of a step needs the acceleration 1 s earlier. For the first steps after the request
  // the log lacks this acceleration.
  expected["max_abs_jerk_1s_mps3"] = nullptr;
  EXPECT_EQ(measured[0], expected);
}

TEST_F(LateLogTest, LeavesOutTheRequestThatItBeginsIn) {
  const std::string log = From(asked_ + 1);
  const nlohmann::json events = Json({"events", log}, 1)[0];
  EXPECT_EQ(events["events"], EventsFrom(asked_ + 1, "DEMAND"));
  EXPECT_EQ(events["requests"], nlohmann::json::array());
  EXPECT_FALSE(Json({"metrics", log}, 1)[0].contains("take_overs"));
  const std::string unknown = "the measures of a request that may have begun before the log";
  EXPECT_EQ(events["unknown_take_overs"], unknown);
  EXPECT_EQ(Json({"metrics", log}, 1)[0]["unknown_take_overs"], unknown);
  EXPECT_THAT(Fogline({"events", log}).err,
              HasSubstr("unknown, because messages are missing: " + unknown + "\n"));
  EXPECT_THAT(Fogline({"metrics", log}).err,
              HasSubstr(", " + unknown + "; the other measures are of the steps in the log\n"));
  const std::string table = folder_.File("take-overs.csv");
  EXPECT_EQ(Fogline({"metrics", log, "--take-overs", table}).code, 1);
  EXPECT_THAT(Content(table), HasSubstr("\n" + log + ",1,,unknown,,"));
  const std::string page = folder_.File("report.html");
  EXPECT_EQ(Fogline({"report", log, "--output", page}).code, 1);
  EXPECT_THAT(Content(page), HasSubstr(unknown));
}

TEST_F(LateLogTest, MayBeginInTheMiddleOfAStep) {
  const std::int64_t first = asked_ - 20;
  const std::string log = Without([&](std::string_view channel, std::int64_t step) {
    return channel != "RUN" && (step < first || (step == first && channel != "HOST_COMMAND"));
  });
  const nlohmann::json metrics = Json({"metrics", log}, 1)[0];
  EXPECT_EQ(metrics["gaps"]["first_step"], first);
  EXPECT_EQ(metrics["take_overs"], nlohmann::json::array({measures_}));
  EXPECT_EQ(metrics["metrics"], Json({"metrics", From(first + 1)}, 1)[0]["metrics"]);
  EXPECT_FALSE(metrics["metrics"]["human_time_s"].is_null());
}

TEST_F(LateLogTest, DoesNotKnowWhatAMessageThatItsFirstStepLacksWouldShow) {
  const std::int64_t first = asked_ - 20;
  const std::string log = Without([&](std::string_view channel, std::int64_t step) {
    return channel != "RUN" && (step < first || (step == first && channel == "HOST_COMMAND"));
  });
  const nlohmann::json metrics = Json({"metrics", log}, 1)[0];
  for (const char* unknown : {"transfers", "human_time_s", "wrong_human_s", "false_alarms_ph"}) {
    EXPECT_TRUE(metrics["metrics"][unknown].is_null()) << unknown;
  }
  EXPECT_EQ(metrics["unknown_take_overs"], "requests in a gap and the measures of take-overs");
}

TEST_F(LateLogTest, SaysThatARequestAfterAGapMayHaveBegunInTheGap) {
  const std::int64_t lost = asked_ - 3;
  const std::string log = Without([&](std::string_view channel, std::int64_t step) {
    return channel == "HOST_COMMAND" && step >= lost && step <= asked_;
  });
  const nlohmann::json events = Json({"events", log}, 1)[0];
  nlohmann::json expected = events_.at(1);
  expected["step"] = asked_ + 1;
  expected["time_s"] = static_cast<double>(asked_ + 1) / 10;
  expected["earliest_step"] = lost;
  EXPECT_EQ(events["events"].at(1), expected);
  EXPECT_EQ(events["requests"].at(0)["may_be_earlier"], nlohmann::json({"requested_s"}));
  const std::string text = Fogline({"events", log}).out;
  EXPECT_THAT(text, HasSubstr(", in one of the steps " + std::to_string(lost) + " to " +
                              std::to_string(asked_ + 1) + "\n"));
  EXPECT_THAT(text, HasSubstr(" s or before acknowledged "));
  const std::string table = folder_.File("take-overs.csv");
  EXPECT_EQ(Fogline({"metrics", log, "--take-overs", table}).code, 1);
  EXPECT_THAT(Content(table), HasSubstr("\n" + log + ",1,,unknown,,"));
}

TEST_F(LateLogTest, ALogThatIsCutOffDoesNotKnowTheOutcomeOfItsRequest) {
  const std::string log = Without([&](std::string_view channel, std::int64_t step) {
    return channel != "RUN" && step > asked_ + 2;
  });
  const nlohmann::json request = Json({"metrics", log}, 1)[0]["take_overs"].at(0);
  EXPECT_EQ(request["outcome"], "unknown");
  EXPECT_EQ(request["judged_s"], nullptr);
  EXPECT_EQ(request["requested_s"], measures_["requested_s"]);
  EXPECT_EQ(Json({"events", log}, 1)[0]["requests"].at(0)["measures"]["outcome"], "unknown");
  const std::string table = folder_.File("take-overs.csv");
  EXPECT_EQ(Fogline({"metrics", log, "--take-overs", table}).code, 1);
  EXPECT_THAT(Content(table), HasSubstr("\n" + log + ",1,1,unknown,"));
  const std::string page = folder_.File("report.html");
  EXPECT_EQ(Fogline({"report", log, "--output", page}).code, 1);
  EXPECT_THAT(Content(page), HasSubstr("<td>unknown: the log ends first</td>"));
}

TEST_F(LateLogTest, DoesNotKnowRequestsOutsideOfIt) {
  // GIVEN a log that begins after the end of the request, and a log that ends before the request
  const std::string after = From(static_cast<std::int64_t>(events_.back()["step"]) + 1);
  const std::string table = folder_.File("take-overs.csv");
  const auto expect_unknown = [&](const std::string& log, const std::string& what) {
    EXPECT_EQ(Json({"events", log}, 1)[0]["unknown_take_overs"], what);
    EXPECT_EQ(Json({"metrics", log}, 1)[0]["unknown_take_overs"], what);
    EXPECT_EQ(Fogline({"metrics", log, "--take-overs", table}).code, 1);
    EXPECT_THAT(Content(table), HasSubstr("\n" + log + ",1,,unknown,,"));
  };
  expect_unknown(after, "requests before the beginning of the log");
  const std::string before =
      Without([&](std::string_view channel,
                  std::int64_t step) { return channel != "RUN" && step > asked_ - 10; },
              "before.lcm");
  expect_unknown(before, "requests after the end of the log");
}

TEST_F(LateLogTest, HasNoFalseAlarmThatBeganBeforeIt) {
  const nlohmann::json whole = Json({"metrics", whole_}, 0)[0]["metrics"];
  EXPECT_EQ(whole["false_alarms_ph"], 0);
  for (std::int64_t first = asked_; first < 330; first += 16) {
    EXPECT_EQ(Json({"metrics", From(first)}, 1)[0]["metrics"]["false_alarms_ph"], 0) << first;
  }
}

}  // namespace
}  // namespace fogline::test
