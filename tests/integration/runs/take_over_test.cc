// Runs in which the car must ask the driver to take over. A run is the same on every transport, and
// its log shows the request.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/runs/transports.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class TakeOverRunTest : public testing::Test {
 protected:
  /// A run with dense fog from 1 s to 5 s. The driver takes over 2 s after the request, or never if
  /// `absent`. Without the driver, the car begins to stop 10 s after the request.
  nlohmann::json Run(const std::string& transport, bool absent,
                     const std::string& policy = "traded") const {
    return RunOn(transport, "scenario/dense_fog.json", Log(transport),
                 {"/steps=130", "/fog/start_s=1", "/fog/duration_s=4",
                  "/arbitrator/policy=" + policy, "/arbitrator/take_over/mode=requested",
                  "/arbitrator/take_over/escalation_s=1", "/arbitrator/take_over/time/mean_s=2",
                  "/arbitrator/take_over/time/std_s=0.01", "/human/loses_awareness=true",
                  "/arbitrator/take_over/absent_probability=" + std::string(absent ? "1" : "0")});
  }
  std::string Log(const std::string& transport) const { return folder_.File(transport + ".lcm"); }

  nlohmann::json Events() const { return FirstOf("events", Log("direct")); }
  nlohmann::json Metrics() const { return FirstOf("metrics", Log("direct")); }
  /// Makes the log of a run in which the driver is not asked. @return its path
  std::string LogWithoutARequest() const {
    const std::string log = Log("paper");
    RunOn("direct", "scenario/paper.json", log, {"/steps=250"});
    return log;
  }
  /// Writes the measures of the take-overs in these logs into a CSV file. @return the contents of
  /// the file
  std::string TakeOvers(const std::vector<std::string>& logs) const {
    const std::string file = folder_.File("take-overs.csv");
    std::vector<std::string> words{Program("fogline"), "metrics", "--take-overs", file};
    words.insert(words.end(), logs.begin(), logs.end());
    const Outcome outcome = RunCommand(words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Content(file);
  }

 private:
  static nlohmann::json FirstOf(const std::string& verb, const std::string& log) {
    const Outcome outcome = RunCommand({Program("fogline"), verb, log, "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false).at(0);
  }

 protected:
  ScratchFolder folder_;
};

TEST_F(TakeOverRunTest, HasTheSameDigestInOneProcessInMemoryAndOverTheNetwork) {
  for (const bool absent : {false, true}) {
    ExpectTheSameOnAnyTransport([&](const std::string& on) { return Run(on, absent); }, 130);
  }
}

TEST_F(TakeOverRunTest, AsksForNoManoeuvreBeforeTenSeconds) {
  const Outcome outcome =
      RunCommand({Program("fogline"), "run", "scenario/dense_fog.json", "--transport", "direct",
                  "--set", "/arbitrator/take_over/lead_s=9.9"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("/arbitrator/take_over/lead_s: 9.9 is outside [10, 20] s"));
}

TEST_F(TakeOverRunTest, IsToldByItsLogAlone) {
  Run("direct", false);
  const auto run = Events();
  EXPECT_EQ(run["complete"], true);
  EXPECT_EQ(run["events"].at(0)["event"], "activation of the automation");
  ASSERT_EQ(run["requests"].size(), 1U) << run.dump(2);
  const auto& request = run["requests"].at(0);
  const double requested_s = request["requested_s"];
  EXPECT_NEAR(request["escalated_s"].get<double>(), requested_s + 1, 1e-9);
  EXPECT_NEAR(request["acknowledged_s"].get<double>(), requested_s + 2, 0.15);
  EXPECT_GT(request["transferred_s"], request["acknowledged_s"]);
  EXPECT_GE(request["effective_s"], request["transferred_s"]);
  EXPECT_TRUE(request["manoeuvre_s"].is_null());
}

TEST_F(TakeOverRunTest, TellsOfTheManoeuvreOfADriverWhoStaysAway) {
  Run("direct", true);
  const auto run = Events();
  ASSERT_EQ(run["requests"].size(), 1U);
  const auto& request = run["requests"].at(0);
  EXPECT_NEAR(request["manoeuvre_s"].get<double>(), request["requested_s"].get<double>() + 10,
              1e-9);
  EXPECT_TRUE(request["transferred_s"].is_null());
  const Outcome text = RunCommand({Program("fogline"), "events", Log("direct")});
  EXPECT_THAT(text.out, HasSubstr("request to take over"));
  EXPECT_THAT(text.out, HasSubstr("DEMAND_URGENT -> MRM_COMFORT"));
}

TEST_F(TakeOverRunTest, IsMeasuredByEveryVerb) {
  Run("direct", false);
  const auto requests = Metrics()["take_overs"];
  ASSERT_EQ(requests.size(), 1U);
  const auto& measures = requests.at(0);
  EXPECT_EQ(measures["outcome"], "taken_over");
  const auto request = Events()["requests"].at(0);
  EXPECT_EQ(request["measures"], measures);
  const double requested_s = request["requested_s"];
  EXPECT_NEAR(measures["requested_s"].get<double>(), requested_s, 1e-9);
  for (const auto& [measure, time] :
       std::map<std::string, std::string>{{"reaction_time_s", "acknowledged_s"},
                                          {"take_over_time_s", "transferred_s"},
                                          {"effective_input_time_s", "effective_s"}}) {
    EXPECT_NEAR(measures[measure].get<double>(), request[time].get<double>() - requested_s, 1e-9)
        << measure;
  }
  EXPECT_TRUE(measures["pedal_on_time_s"].is_null()) << "no person drives";
  EXPECT_GT(measures["max_deceleration_mps2"], measures["mean_deceleration_mps2"]);

  const Outcome text = RunCommand({Program("fogline"), "metrics", Log("direct")});
  EXPECT_THAT(text.out, HasSubstr("\n  take-over 1: taken over\n    requested_s "));
  const Outcome listed = RunCommand({Program("fogline"), "events", Log("direct")});
  EXPECT_THAT(listed.out, HasSubstr("\n    taken over; reaction time 2."));
  const std::string page = folder_.File("page.html");
  RunCommand({Program("fogline"), "report", Log("direct"), "--output", page});
  EXPECT_THAT(Content(page), HasSubstr("<h2 id=\"take-overs-title\">Take-overs</h2>"));
}

TEST_F(TakeOverRunTest, ShowsWhatDroveUntilTheTakeOver) {
  // GIVEN a policy that asks the driver, and excludes the LiDAR until the driver drives
  Run("direct", false, "traded_isolating");
  const auto measures = Events()["requests"].at(0)["measures"];
  const auto value = [&measures](const char* name) { return measures[name].get<double>(); };
  // THEN the automation drives until the take-over, and drives without the LiDAR for a part of this
  // time
  EXPECT_NEAR(value("automation_drove_s"), value("take_over_time_s"), 1e-9);
  EXPECT_GT(value("sensor_excluded_s"), 1);
  EXPECT_LE(value("sensor_excluded_s"), value("automation_drove_s"));
  EXPECT_NEAR(value("automation_drove_s") + value("driver_drove_s"), value("judged_s"), 1e-9);
  EXPECT_EQ(measures["manoeuvre_drove_s"], 0);
  // THEN `fogline events` and the page of `fogline report` show the time without the LiDAR
  const Outcome listed = RunCommand({Program("fogline"), "events", Log("direct")});
  EXPECT_THAT(listed.out, HasSubstr("; of this with a sensor excluded 1."));
  const std::string page = folder_.File("page.html");
  RunCommand({Program("fogline"), "report", Log("direct"), "--output", page});
  EXPECT_THAT(Content(page), HasSubstr("<small>sensor_excluded_s</small>"));
  // THEN a run under traded control excludes no sensor
  EXPECT_EQ(Run("direct", false)["take_overs"].at(0)["sensor_excluded_s"], 0);
}

TEST_F(TakeOverRunTest, IsMeasuredDuringTheRunAsFromItsLog) {
  const auto run = Run("direct", false);
  EXPECT_EQ(run["take_overs"], Metrics()["take_overs"]);
  EXPECT_EQ(run["take_overs"].size(), 1U);
}

TEST_F(TakeOverRunTest, OfADriverWhoStaysAwayIsAMinimalRiskManoeuvre) {
  Run("direct", true);
  const auto measures = Metrics()["take_overs"].at(0);
  EXPECT_EQ(measures["outcome"], "minimal_risk");
  EXPECT_NEAR(measures["manoeuvre_time_s"].get<double>(), 10, 1e-9);
  EXPECT_TRUE(measures["take_over_time_s"].is_null());
}

TEST_F(TakeOverRunTest, LeavesNoTraceInARunWithoutARequest) {
  const std::string log = LogWithoutARequest();
  for (const char* verb : {"metrics", "events"}) {
    for (const char* format : {"--json", ""}) {
      std::vector<std::string> words{Program("fogline"), verb, log};
      if (*format != '\0') words.emplace_back(format);
      const Outcome outcome = RunCommand(words);
      EXPECT_EQ(outcome.code, 0) << outcome.err;
      EXPECT_THAT(outcome.out, Not(HasSubstr("take_overs"))) << verb << format;
      EXPECT_THAT(outcome.out, Not(HasSubstr("take-over"))) << verb << format;
      EXPECT_THAT(outcome.out, Not(HasSubstr("input_latency"))) << verb << format;
    }
  }
  const std::string page = folder_.File("page.html");
  RunCommand({Program("fogline"), "report", log, "--output", page});
  EXPECT_THAT(Content(page), HasSubstr("<h2 id=\"measures-title\">"));
  EXPECT_THAT(Content(page), Not(HasSubstr("take-overs")));
}

TEST_F(TakeOverRunTest, IsALineOfACsvFile) {
  Run("direct", false);
  Run("memq", true);
  const std::string text = TakeOvers({Log("direct"), LogWithoutARequest(), Log("memq")});
  EXPECT_THAT(text, StartsWith("log,seed,request,outcome,requested_s,"));
  EXPECT_EQ(std::ranges::count(text, '\n'), 3);
  EXPECT_THAT(text, HasSubstr("\n" + Log("direct") + ",1,1,taken_over,"));
  EXPECT_THAT(text, HasSubstr("\n" + Log("memq") + ",1,1,minimal_risk,"));
}

TEST_F(TakeOverRunTest, ReplacesNoOtherFileByItsCsvFile) {
  const std::string log = LogWithoutARequest();
  const std::string before = Content(log);
  const Outcome outcome = RunCommand({Program("fogline"), "metrics", log, "--take-overs", log});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, log +
                             ": error: --take-overs: the file is no table of take-overs and is "
                             "not replaced\n");
  EXPECT_EQ(Content(log), before);
  TakeOvers({log});
  const std::string table = TakeOvers({log});  // a table of take-overs is replaced
  const std::string file = folder_.File("take-overs.csv");
  EXPECT_EQ(
      RunCommand({Program("fogline"), "metrics", folder_.File("none"), "--take-overs", file}).code,
      2);
  EXPECT_EQ(Content(file), table) << "the table is kept if a log cannot be read";
}

TEST_F(TakeOverRunTest, WritesItsCsvFileAlsoToStdout) {
  Run("direct", false);
  const Outcome text =
      RunCommand({Program("fogline"), "metrics", Log("direct"), "--take-overs", "/dev/stdout"});
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_EQ(std::ranges::count(text.out, '\n'), 2) << text.out;
  EXPECT_THAT(text.err, HasSubstr("take-over 1: taken over"));
  const Outcome json = RunCommand(
      {Program("fogline"), "metrics", Log("direct"), "--take-overs", "/dev/stdout", "--json"});
  EXPECT_EQ(json.code, 2);
  EXPECT_THAT(json.err, HasSubstr("--take-overs /dev/stdout uses stdout already"));
}

}  // namespace
}  // namespace fogline::test
