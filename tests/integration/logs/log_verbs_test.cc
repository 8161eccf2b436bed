// Outputs of the verbs that read logs, for logs that are cut off, and for logs with another step
// length.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/log/event_log.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/command.h"
#include "tests/support/copied_log.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

Outcome Fogline(std::vector<std::string> words) {
  words.insert(words.begin(), Program("fogline"));
  return RunCommand(words);
}

class CutLogTest : public testing::Test {
 protected:
  CutLogTest() {
    const Outcome run = Fogline({"run", "scenario/paper.json", "--transport", "direct", "--set",
                                 "/steps=40", "--log", whole_});
    EXPECT_EQ(run.code, 0) << run.err;
    Copy(whole_, cut_, [](auto&, const log::Event& event, auto& data) {
      return !(event.channel == ChannelOf<truth_t>().name &&
               runtime::ReadInt64(data, runtime::kStepOffset) == 20);
    });
  }
  const ScratchFolder folder_;
  const std::string whole_ = folder_.File("whole.lcm");
  const std::string cut_ = folder_.File("cut.lcm");
};

TEST_F(CutLogTest, DiffersFromTheWholeOneInTheFirstStepThatItLacks) {
  const Outcome diff = Fogline({"diff", whole_, cut_});
  EXPECT_EQ(diff.code, 1);
  EXPECT_EQ(diff.out, "step 20: (run) (step): there in " + whole_ + ", none in " + cut_ + "\n");
  const Outcome json = Fogline({"diff", cut_, whole_, "--json"});
  EXPECT_EQ(json.code, 1);
  EXPECT_EQ(nlohmann::json::parse(json.out)["equal"], false);
}

TEST_F(CutLogTest, IsNoProofThatTwoRunsAreEqual) {
  const Outcome cut = Fogline({"diff", cut_, cut_});
  EXPECT_EQ(cut.code, 1);
  EXPECT_EQ(cut.out, "equal: 20 steps\n");
  EXPECT_THAT(cut.err, HasSubstr("ends after step 19 of 40"));
  EXPECT_EQ(Fogline({"diff", whole_, whole_}).code, 0);
}

TEST_F(CutLogTest, HasMeasuresButFailsTheCheck) {
  EXPECT_EQ(Fogline({"metrics", whole_}).code, 0);
  const Outcome cut = Fogline({"metrics", cut_});
  EXPECT_EQ(cut.code, 1);
  EXPECT_THAT(cut.err, HasSubstr("ends after step 19 of 40"));
}

TEST(EventsOfOtherStepsTest, HaveTheTimesOfTheirSteps) {
  const ScratchFolder folder;
  const std::string log = folder.File("asked.lcm");
  const Outcome run = Fogline({"run", "scenario/paper.json", "--transport", "direct", "--set",
                               "/step_s=0.05", "--set", "/steps=600", "--set",
                               "/arbitrator/take_over/mode=requested", "--log", log});
  ASSERT_EQ(run.code, 0) << run.err;
  const Outcome events = Fogline({"events", log, "--json"});
  ASSERT_EQ(events.code, 0) << events.err;
  const auto document = nlohmann::json::parse(events.out)[0];
  ASSERT_FALSE(document["requests"].empty());
  const double requested_s = document["requests"][0]["requested_s"];
  EXPECT_GT(requested_s, 19) << "in the fog";
  EXPECT_LT(requested_s, 30);
  bool is_listed = false;
  for (const auto& event : document["events"]) {
    EXPECT_NEAR(event["time_s"].get<double>(), 0.05 * event["step"].get<double>(), 1e-9);
    is_listed = is_listed || std::abs(event["time_s"].get<double>() - requested_s) < 1e-9;
  }
  EXPECT_TRUE(is_listed) << requested_s;
}

TEST(ComparedSpreadTest, IsTheDeviationOfTheDifferencesFromTheirMean) {
  const ScratchFolder folder;
  const std::string log = folder.File("lead.lcm");
  const Outcome run =
      Fogline({"run", "scenario/recorded_lead.json", "--transport", "direct", "--log", log});
  ASSERT_EQ(run.code, 0) << run.err;
  const Outcome compared = Fogline({"compare", log, "scenario/data/acc_platoon_a.csv", "--json"});
  ASSERT_EQ(compared.code, 0) << compared.err;
  const auto json = nlohmann::json::parse(compared.out);
  const double bias = json["mean_gap_m"].get<double>() - json["recorded_mean_gap_m"].get<double>();
  EXPECT_GT(std::abs(bias), 0.1) << "the scenario's car has another time gap";
  EXPECT_NEAR(std::pow(json["gap_spread_m"].get<double>(), 2) + bias * bias,
              std::pow(json["gap_rmse_m"].get<double>(), 2), 1e-6);
}

}  // namespace
}  // namespace fogline::test
