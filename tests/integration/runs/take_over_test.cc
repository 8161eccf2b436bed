// The car must ask the driver to take over. The run is the same on every transport, and its log
// shows the request.
#include <string>

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/runs/transports.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;

class TakeOverRunTest : public testing::Test {
 protected:
  /// A run with dense fog from 1 s to 5 s. The driver takes over 2 s after the request, or never.
  /// The car begins to stop 10 s after its request.
  nlohmann::json Run(const std::string& transport, bool absent) const {
    return RunOn(transport, "scenario/dense_fog.json", Log(transport),
                 {"/steps=130", "/fog/start_s=1", "/fog/duration_s=4",
                  "/arbitrator/take_over/mode=requested", "/arbitrator/take_over/escalation_s=1",
                  "/arbitrator/take_over/time/mean_s=2", "/arbitrator/take_over/time/std_s=0.01",
                  "/human/loses_awareness=true",
                  "/arbitrator/take_over/absent_probability=" + std::string(absent ? "1" : "0")});
  }
  std::string Log(const std::string& transport) const { return folder_.File(transport + ".lcm"); }

  nlohmann::json Events() const {
    const Outcome outcome = RunCommand({Program("fogline"), "events", Log("direct"), "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false).at(0);
  }

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

}  // namespace
}  // namespace fogline::test
