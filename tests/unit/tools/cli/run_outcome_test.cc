#include "tools/cli/run_outcome.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace fogline::cli {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// The outcome of a run without any trouble.
RunOutcome Undisturbed() {
  RunOutcome outcome{.file = "paper.json", .steps = 500, .result = {}};
  outcome.result.seed = 3;
  outcome.result.transport = "udpm";
  outcome.result.steps = 500;
  outcome.result.digest = "63a1";
  outcome.result.wall_s = 1.25;
  outcome.result.log = "run.lcm";
  return outcome;
}

/// The outcome of a run with all kinds of trouble.
RunOutcome Troubled() {
  RunOutcome outcome = Undisturbed();
  outcome.resumed = 100;
  runner::RunResult& result = outcome.result;
  result.steps = 123;
  result.repairs = 7;
  result.refused[0] = 2;
  result.send_troubles = {{.role = "world", .count = 3, .error = "Network is unreachable"}};
  result.foreign_peers = {{.role = "acc", .pid = 9, .host = "lab2", .run_id = 5}};
  result.restarts = {{.role = "acc", .count = 1, .last = "was killed"},
                     {.role = "driver", .count = 2, .last = "hung"}};
  result.other_builds = {
      {.role = Role::kDriver, .pid = 8, .host = "lab3", .build = 0, .ours = 0x2e}};
  result.checked = false;
  result.verification.emplace();
  result.verification->roles = {Role::kWorld, Role::kAcc};
  result.verification->left_out = {{.role = Role::kDriver, .why = "of an unknown build"}};
  return outcome;
}

TEST(RunOutcomeTest, BeginsWithTheRunAndEndsWithItsMeasures) {
  const std::string text = ToText(Undisturbed());
  EXPECT_THAT(text, StartsWith("paper.json: 500 steps in 1.25 s over udpm, 0 repairs\n"
                               "digest 63a1\nlog    run.lcm\n  steps "));
  EXPECT_THAT(text, HasSubstr("  min_host_gap_m "));
}

TEST(RunOutcomeTest, TellsEveryTrouble) {
  const std::string text = ToText(Troubled());
  EXPECT_THAT(text, StartsWith("paper.json: 123 of 500 steps, 100 of them from the log in 1.25 s "
                               "over udpm, 7 repairs\n"
                               "refused messages: 2 of other runs\n"
                               "messages that could not be sent: world 3 (Network is unreachable)\n"
                               "acc was started again once: was killed\n"
                               "driver was started again 2 times: hung\n"
                               "another build: driver (pid 8 on lab3) "));
  EXPECT_THAT(text,
              HasSubstr("verified: world acc\nnot verified: driver (of an unknown build)\n"
                        "the end of the log is not checked, because the recorder's last report "
                        "was lost\ndigest 63a1\n"));
}

TEST(RunOutcomeTest, TellsNothingOfAComputationThatDidNotTakePlace) {
  RunOutcome outcome = Undisturbed();
  outcome.computed = false;
  outcome.result.checked = false;
  outcome.result.log.clear();
  EXPECT_THAT(ToText(outcome), StartsWith("paper.json: 500 steps\ndigest 63a1\n  steps "));
  EXPECT_TRUE(ToJson(outcome)["transport"].is_null());
  EXPECT_TRUE(ToJson(outcome)["log"].is_null());
}

TEST(RunOutcomeTest, HasEveryFactInItsJson) {
  const auto json = ToJson(Troubled());
  EXPECT_EQ(json["scenario"], "paper.json");
  EXPECT_EQ(json["seed"], 3);
  EXPECT_EQ(json["transport"], "udpm");
  EXPECT_EQ(json["steps"], 123);
  EXPECT_EQ(json["resumed_steps"], 100);
  EXPECT_EQ(json["digest"], "63a1");
  EXPECT_EQ(json["wall_s"], 1.25);
  EXPECT_EQ(json["log"], "run.lcm");
  EXPECT_EQ(json["repairs"], 7);
  EXPECT_EQ(json["refused"]["foreign"], 2);
  EXPECT_EQ(json["refused"].size(), runtime::kRefusals.size());
  EXPECT_EQ(json["failed_sends"].dump(),
            R"([{"role":"world","count":3,"error":"Network is unreachable"}])");
  EXPECT_EQ(json["strangers"].dump(), R"([{"role":"acc","pid":9,"host":"lab2","run_id":5}])");
  EXPECT_EQ(json["restarts"].size(), 2U);
  EXPECT_EQ(json["restarts"][1].dump(), R"({"role":"driver","count":2,"last":"hung"})");
  EXPECT_EQ(json["log_checked"], false);
  EXPECT_EQ(json["other_builds"].dump(), R"([{"role":"driver","pid":8,"host":"lab3","build":null,)"
                                         R"("expected":"000000000000002e"}])");
  EXPECT_EQ(json["verified"].dump(),
            R"({"same":true,"roles":["world","acc"],)"
            R"("left_out":[{"role":"driver","why":"of an unknown build"}],"trouble":null})");
  EXPECT_FALSE(json.contains("realtime"));
  EXPECT_TRUE(json["metrics"].contains("min_host_gap_m"));

  const auto undisturbed = ToJson(Undisturbed());
  EXPECT_TRUE(undisturbed["resumed_steps"].is_null());
  EXPECT_TRUE(undisturbed["verified"].is_null());
  EXPECT_EQ(undisturbed["restarts"].dump(), "[]");
}

TEST(RunOutcomeTest, NamesTheDifferenceThatAVerificationFound) {
  RunOutcome outcome = Troubled();
  outcome.result.verification->failure = {
      .role = Role::kAcc,
      .first = {.step = 17, .channel = "ACC_COMMAND", .field = "x", .a = "1", .b = "2"}};
  const auto json = ToJson(outcome)["verified"];
  EXPECT_EQ(json["same"], false);
  EXPECT_EQ(json["trouble"], outcome.result.verification->Trouble());
  EXPECT_EQ(json["first"].dump(),
            R"({"role":"acc","step":17,"channel":"ACC_COMMAND","field":"x","log":"1",)"
            R"("replay":"2"})");
}

TEST(RunOutcomeTest, HasTheFiguresOfARunInRealTime) {
  RunOutcome outcome = Undisturbed();
  outcome.result.realtime.emplace();
  outcome.result.realtime->has_status = true;
  outcome.result.realtime->ticks_late = 4;
  EXPECT_EQ(ToJson(outcome)["realtime"]["ticks_late"], 4);
  EXPECT_THAT(ToText(outcome), HasSubstr("\n  ticks_late "));
  EXPECT_THAT(ToText(Undisturbed()), Not(HasSubstr("ticks_late")));
}

}  // namespace
}  // namespace fogline::cli
