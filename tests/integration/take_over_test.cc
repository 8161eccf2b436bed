// A driver who must be asked: the same run however its messages travel, and a log that tells it.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;

class TakeOverRunTest : public testing::Test {
 protected:
  /// Dense fog from the first second on; he comes after 2 s, within 60 steps, or stays away.
  nlohmann::json Run(const std::string& transport, bool absent) const {
    const Outcome outcome =
        RunCommand({Program("fogline"),
                    "run",
                    "scenario/dense_fog.json",
                    "--json",
                    "--quiet",
                    "--transport",
                    transport,
                    "--log",
                    Log(transport),
                    "--force",
                    "--set",
                    "/steps=60",
                    "--set",
                    "/fog/start_s=1",
                    "--set",
                    "/fog/duration_s=4",
                    "--set",
                    "/arbitrator/take_over/mode=requested",
                    "--set",
                    "/arbitrator/take_over/lead_s=2.5",
                    "--set",
                    "/arbitrator/take_over/escalation_s=1",
                    "--set",
                    "/arbitrator/take_over/time/mean_s=2",
                    "--set",
                    "/arbitrator/take_over/time/std_s=0.01",
                    "--set",
                    "/human/loses_awareness=true",
                    "--set",
                    "/arbitrator/take_over/absent_probability=" + std::string(absent ? "1" : "0")});
    EXPECT_EQ(outcome.code, 0) << transport << ": " << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
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
    const auto direct = Run("direct", absent);
    ASSERT_EQ(direct["digest"].get<std::string>().size(), 64U);
    for (const char* transport : {"memq", "udpm"}) {
      const auto other = Run(transport, absent);
      EXPECT_EQ(other["steps"], 60) << transport;
      EXPECT_EQ(other["digest"], direct["digest"]) << transport;
    }
  }
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
  EXPECT_NEAR(request["manoeuvre_s"].get<double>(), request["requested_s"].get<double>() + 2.5,
              1e-9);
  EXPECT_TRUE(request["transferred_s"].is_null());
  const Outcome text = RunCommand({Program("fogline"), "events", Log("direct")});
  EXPECT_THAT(text.out, HasSubstr("request to take over"));
  EXPECT_THAT(text.out, HasSubstr("DEMAND_URGENT -> MRM_COMFORT"));
}

}  // namespace
}  // namespace fogline::test
