// `fogline run` as a person uses it: with real processes, LCM and logs.
#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::ContainsRegex;

/// Runs paper.json with further options. @return the JSON result
nlohmann::json RunPaper(const std::string& log, const std::vector<std::string>& more) {
  std::vector<std::string> command{
      Program("fogline"), "run", "scenario/paper.json", "--json", "--quiet", "--log", log};
  command.insert(command.end(), more.begin(), more.end());
  const Outcome outcome = RunCommand(command);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false);
}

TEST(RunTest, GivesTheSameDigestOnEveryTransportAndEveryTime) {
  const ScratchFolder folder;
  const auto direct = RunPaper(folder.File("direct.lcm"), {"--transport", "direct"});
  const auto memq = RunPaper(folder.File("memq.lcm"), {"--transport", "memq"});
  const auto udpm = RunPaper(folder.File("udpm.lcm"), {"--transport", "udpm"});
  const auto again = RunPaper(folder.File("again.lcm"), {"--transport", "udpm"});
  EXPECT_EQ(direct["steps"], 500);
  EXPECT_EQ(udpm["steps"], 500);
  EXPECT_EQ(udpm["digest"].get<std::string>().size(), 64U);
  EXPECT_EQ(memq["digest"], direct["digest"]);
  EXPECT_EQ(udpm["digest"], direct["digest"]);
  EXPECT_EQ(again["digest"], direct["digest"]);
  EXPECT_EQ(udpm["metrics"], direct["metrics"]);
}

TEST(RunTest, NamesTheFirstStepAndFieldInWhichRunsOfTwoSeedsDiffer) {
  const ScratchFolder folder;
  const auto one = RunPaper(folder.File("one.lcm"), {"--transport", "memq", "--seed", "1"});
  const auto two = RunPaper(folder.File("two.lcm"), {"--transport", "memq", "--seed", "2"});
  EXPECT_NE(one["digest"], two["digest"]);
  // The radar draws the first random number of a run, at step 0. So runs with different seeds first
  // differ there.
  const Outcome diff =
      RunCommand({Program("fogline"), "diff", folder.File("one.lcm"), folder.File("two.lcm")});
  EXPECT_EQ(diff.code, 1);
  EXPECT_EQ(diff.out.find("step 0: RADAR range_m: "), 0U) << diff.out;
  const Outcome same =
      RunCommand({Program("fogline"), "diff", folder.File("one.lcm"), folder.File("one.lcm")});
  EXPECT_EQ(same.code, 0);
  EXPECT_EQ(same.out, "equal: 500 steps\n");
}

TEST(RunTest, MeasuresALogAsItMeasuredTheRun) {
  const ScratchFolder folder;
  const auto run = RunPaper(folder.File("run.lcm"), {"--transport", "udpm"});
  const Outcome metrics =
      RunCommand({Program("fogline"), "metrics", folder.File("run.lcm"), "--json"});
  ASSERT_EQ(metrics.code, 0) << metrics.err;
  const auto measured = nlohmann::json::parse(metrics.out);
  EXPECT_EQ(measured[0]["metrics"], run["metrics"]);
  EXPECT_EQ(measured[0]["digest"], run["digest"]);
  EXPECT_EQ(measured[0]["complete"], true);
}

TEST(RunTest, PrintsDigitsThatMeanSomethingAndHasAllOfThemInJson) {
  // GIVEN a calm run in which the human always drives
  const ScratchFolder folder;
  const std::vector<std::string> more{"--transport", "direct", "--set",
                                      "/arbitrator/threshold=0.2"};
  const auto json = RunPaper(folder.File("run.lcm"), more)["metrics"];
  const Outcome text = RunCommand({Program("fogline"), "metrics", folder.File("run.lcm")});
  ASSERT_EQ(text.code, 0) << text.err;
  // THEN the text shortens a very long time to collision, and a number that is nearly 0
  EXPECT_GT(json["min_follower_ttc_s"], 1e6);
  EXPECT_THAT(text.out, ContainsRegex("min_follower_ttc_s +> 1000 s\n"));
  EXPECT_GT(json["max_compromised_safety_m"], 0);
  EXPECT_THAT(text.out, ContainsRegex("max_compromised_safety_m +< 0\\.001 m\n"));
  EXPECT_EQ(json["host_tet_s"], 0);
  EXPECT_THAT(text.out, ContainsRegex("host_tet_s +0 s\n"));
  EXPECT_THAT(text.out, ContainsRegex("steps +500 \n"));
}

TEST(RunTest, WritesTheSameLogByteForByteWhateverTheTransport) {
  // GIVEN the logs of one run on three transports
  const ScratchFolder folder;
  RunPaper(folder.File("memq.lcm"), {"--transport", "memq"});
  RunPaper(folder.File("udpm.lcm"), {"--transport", "udpm"});
  RunPaper(folder.File("direct.lcm"), {"--transport", "direct"});
  const auto size = [&](const char* name) { return std::filesystem::file_size(folder.File(name)); };
  // THEN all logs have the same size. Two of them have the same events in the same order, and
  // differ only in run ids
  EXPECT_EQ(size("memq.lcm"), size("udpm.lcm"));
  EXPECT_EQ(size("memq.lcm"), size("direct.lcm"));
  const Outcome diff =
      RunCommand({Program("fogline"), "diff", folder.File("memq.lcm"), folder.File("udpm.lcm")});
  EXPECT_EQ(diff.code, 0) << diff.out;
}

TEST(RunTest, InMemoryMayTakeLongerThanAStepMay) {
  const ScratchFolder folder;
  const auto seconds = [&folder](int steps) -> double {
    return RunPaper(folder.File(std::to_string(steps)),
                    {"--transport", "memq", "--set", "/steps=" + std::to_string(steps),
                     "--stall-timeout", "1"})["wall_s"];
  };
  // WHEN the runs get longer and longer, until one takes longer than the stall timeout of 1 s, THEN
  // each of them succeeds
  int steps = 100'000;
  while (seconds(steps) < 1.2) steps *= 2;
}

TEST(RunTest, EndsAtACollisionIfTheScenarioSaysSo) {
  const ScratchFolder folder;
  // GIVEN a leader that makes an emergency stop, and an ACC that can hardly brake
  const auto run =
      RunPaper(folder.File("crash.lcm"),
               {"--transport", "udpm", "--set", "/lead/profile=emergency_brake", "--set",
                "/arbitrator/policy=none", "--set", "/acc/min_acceleration_mps2=-0.1"});
  EXPECT_EQ(run["metrics"]["collision"], 1);
  EXPECT_GT(run["metrics"]["collision_time_s"], 10.0);
  EXPECT_LT(run["steps"], 500);
  const Outcome digest = RunCommand({Program("fogline"), "digest", folder.File("crash.lcm")});
  EXPECT_EQ(digest.code, 0) << "the log of a run that ends early is complete: " << digest.err;
}

TEST(RunTest, DoesNotOverwriteALogUnlessForced) {
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  ASSERT_EQ(RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                        "--set", "/steps=10", "--log", log})
                .code,
            0);
  const auto size = std::filesystem::file_size(log);
  const std::vector<std::string> command{
      Program("fogline"), "run", "scenario/paper.json", "--transport", "direct", "--log", log};
  Outcome outcome = RunCommand(command);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, log + ": error: --log: the file exists; --force replaces it\n");
  EXPECT_EQ(std::filesystem::file_size(log), size);
  std::vector<std::string> forced = command;
  forced.emplace_back("--force");
  EXPECT_EQ(RunCommand(forced).code, 0);
  EXPECT_GT(std::filesystem::file_size(log), size);
}

TEST(RunTest, ReplacesNothingButAnEventLogEvenWhenForced) {
  const ScratchFolder folder;
  const std::string scenario = folder.File("mine.json");
  std::ofstream(scenario) << "precious";
  const Outcome outcome = RunCommand({Program("fogline"), "run", "scenario/paper.json",
                                      "--transport", "direct", "--force", "--log", scenario});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(
      outcome.err,
      scenario +
          ": error: --log: the file is no event log and is not replaced, even with --force\n");
  EXPECT_EQ(std::filesystem::file_size(scenario), 8U);
}

TEST(RunTest, LeavesNoEmptyLogOfARunThatNeverBegan) {
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  EXPECT_NE(RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport",
                        "udpm://nowhere", "--log", log})
                .code,
            0);
  EXPECT_FALSE(std::filesystem::exists(log));
}

TEST(RunTest, MakesNoFolderForALogButTheDefaultOne) {
  const ScratchFolder folder;
  const auto run = [&](const std::string& log) {
    return RunCommand({"sh", "-c",
                       "cd " + folder.path().string() + " && " + Program("fogline") + " run " +
                           (SourceDirectory() / "scenario/paper.json").string() +
                           " --transport direct --set /steps=10 --log " + log});
  };
  const Outcome slip = run("nonexist/dir/x.lcm");
  EXPECT_EQ(slip.code, 2);
  EXPECT_EQ(slip.err, "nonexist/dir/x.lcm: error: --log: there is no folder nonexist/dir\n");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_EQ(run("logs/x.lcm").code, 0);
  EXPECT_EQ(run("./logs/y.lcm").code, 0);
  EXPECT_EQ(run("z.lcm").code, 0);
}

TEST(RunTest, SpeaksOfNoStepBeforeTheFirst) {
  // GIVEN a run that waits for its driver
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  Background run({Program("fogline"), "run", "scenario/paper.json", "--log", log, "--external",
                  "driver", "--lcm-url", runtime::FreshMulticastUrl()});
  ASSERT_TRUE(run.WaitForErr("waiting for the driver"));
  ASSERT_TRUE(GrowsTo(1, log));
  // WHEN a role is killed, and then the runner
  kill(PidOf(run.Err(), "radar"), SIGKILL);
  EXPECT_TRUE(run.WaitForErr("was killed by signal 9 (Killed) before step 0; started again"))
      << run.Err();
  run.Signal(SIGKILL);
  run.Wait();
  // THEN no text about the run or its log mentions a step -1
  const Outcome metrics = RunCommand({Program("fogline"), "metrics", log});
  EXPECT_EQ(metrics.code, 1);
  EXPECT_EQ(metrics.err, log + ": no step of 500 is complete\n");
  EXPECT_EQ((run.Err() + metrics.out).find("step -1"), std::string::npos);
}

TEST(RunTest, MeasuresTheTimeFromDeceptionToAlarmUnderItsOwnName) {
  const Outcome run = RunCommand(
      {Program("fogline"), "run", "scenario/paper.json", "--transport", "direct", "--json"});
  const auto metrics = nlohmann::json::parse(run.out)["metrics"];
  EXPECT_EQ(metrics["deception_to_alarm_s"], 0) << "the alarm is there when the LiDAR is deceived";
  EXPECT_FALSE(metrics.contains("detection_delay_s")) << "which a study counts from the fog on";
}

TEST(RunTest, FailsWhereItsResultCannotBeWritten) {
  for (const char* what : {"scenario/paper.json --transport direct --set /steps=10", "--help"}) {
    const Outcome outcome =
        RunCommand({"sh", "-c", Program("fogline") + " run " + what + " > /dev/full"});
    EXPECT_EQ(outcome.code, 3) << what;
    EXPECT_EQ(outcome.err,
              "fogline run: error: standard output cannot be written (a full disk?)\n");
  }
}

TEST(RunTest, SaysInItsFirstLineThatItEndedInACollision) {
  const Outcome run =
      RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                  "--set", "/world/host_speed_mps=40", "--set", "/world/host_gap_m=5"});
  EXPECT_EQ(run.code, 0) << run.err;
  const std::string headline = run.out.substr(0, run.out.find('\n'));
  EXPECT_NE(headline.find(": 4 of 500 steps in "), std::string::npos) << headline;
  EXPECT_NE(headline.find(" repairs: the host hit the preceding car at 0.2"), std::string::npos)
      << headline;
}

TEST(RunTest, HangingUpEndsARunAsCtrlCDoes) {
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  Background run({Program("fogline"), "run", "scenario/paper.json", "--pace", "1", "--log", log});
  ASSERT_TRUE(run.WaitForErr("world"));
  run.Signal(SIGHUP);
  EXPECT_EQ(run.Wait(), 130);
}

TEST(DigestTest, WorksOnTheOtherLogsWhenOneIsNone) {
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  ASSERT_EQ(RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                        "--set", "/steps=10", "--log", log})
                .code,
            0);
  for (const char* verb : {"digest", "metrics"}) {
    const Outcome outcome = RunCommand({Program("fogline"), verb, "README.md", log});
    EXPECT_EQ(outcome.code, 2) << verb;
    EXPECT_NE(outcome.err.find("README.md: error: "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.out.find(log), std::string::npos) << outcome.out;
  }
}

TEST(RunTest, RefusesBadArgumentsWithExitCode2AndOneClearLine) {
  const std::string fogline = Program("fogline");
  const auto error = [&](std::vector<std::string> more) {
    std::vector<std::string> command{fogline, "run", "scenario/paper.json", "--quiet"};
    command.insert(command.end(), more.begin(), more.end());
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_NE(error({"--transport", "smoke"}).find("--transport smoke"), std::string::npos);
  EXPECT_NE(error({"--external", "pilot"}).find("pilot"), std::string::npos);
  EXPECT_NE(error({"--external", "driver", "--transport", "memq"}).find("one process"),
            std::string::npos);
  EXPECT_NE(error({"--pace", "-1"}).find("--pace"), std::string::npos);
  for (const char* seed : {"x", "1.5", "9007199254740992"}) {
    EXPECT_EQ(error({"--seed", seed}),
              "fogline run: error: --seed: \"" + std::string(seed) +
                  "\" is no seed: a whole number from 0 to 9007199254740991\n");
  }
  EXPECT_NE(error({"--set", "/arbitrator/threshold=2"}).find("/arbitrator/threshold"),
            std::string::npos);
  EXPECT_EQ(RunCommand({fogline, "run", "no/such.json"}).code, 2);
  EXPECT_EQ(RunCommand({fogline, "metrics", "scenario/paper.json"}).code, 2);
  EXPECT_EQ(RunCommand({fogline, "rum"}).code, 2);
}

}  // namespace
}  // namespace fogline::test
