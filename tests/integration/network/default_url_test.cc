// Every program uses LCM_DEFAULT_URL, as LCM's own programs do. A program that waits for a process
// prints the command that starts this process. The wait has a limit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/log/event_log.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/network/meeting.h"
#include "tests/support/pages.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

TEST(DefaultUrlTest, IsWhereARunGoesThatIsNotToldOtherwise) {
  Meeting meeting;
  Background run(meeting.Run({"--pace", "1"}));
  EXPECT_THAT(PlaceOf(run).url, testing::StartsWith(meeting.url()));
  // On a busy machine a process of the run may send nothing during the 3 s for which top listens.
  // Then the test calls top again.
  json seen = TopOnce(meeting);
  const TimePoint end = Clock::now() + kPatience;
  while (seen["runs"].size() != 1 && Clock::now() < end) seen = TopOnce(meeting);
  EXPECT_EQ(seen["runs"].size(), 1U);
  EXPECT_TRUE(seen["announced"].empty()) << "it is where programs listen";
  // AND the command line has precedence over LCM_DEFAULT_URL
  const std::string other = runtime::FreshMulticastUrl();
  Background told(meeting.Run({"--pace", "1", "--lcm-url", other}));
  EXPECT_THAT(PlaceOf(told).url, testing::StartsWith(other));
  const Outcome direct =
      RunCommand(meeting.Run({"--json", "--transport", "direct", "--set", "/steps=3"}));
  EXPECT_EQ(json::parse(direct.out)["transport"], "direct");
}

TEST(DefaultUrlTest, IsWhereRolesAndRunsMeet) {
  Meeting meeting;
  Background driver(meeting.Command("fogline-driver", {}));
  ASSERT_TRUE(driver.WaitForErr("waiting for a run on " + meeting.url(), kPatience));
  const Outcome run = RunCommand(meeting.Run({"--json", "--external", "driver"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["transport"], meeting.url());
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
  EXPECT_THAT(driver.Err(), Not(HasSubstr("joins run")));
}

TEST(DefaultUrlTest, IsWhereATableFindsARoleFromElsewhere) {
  Meeting meeting;
  Background drivers({"env", "LCM_DEFAULT_URL=" + meeting.url(), "bash", "-c",
                      "while \"$1\"; do :; done", "-", Program("fogline-driver")});
  const std::vector<std::string> what{
      "table", "scenario/paper.json", "--json", "--thresholds", "0.5", "--set", "/steps=250"};
  std::vector<std::string> external = what;
  external.insert(external.end(), {"--external", "driver"});
  const Outcome table = RunCommand(meeting.Command("fogline", external));
  ASSERT_EQ(table.code, 0) << table.err;
  EXPECT_EQ(json::parse(table.out)["transport"], meeting.url());
  // A table without an external role still runs in one process ("direct").
  const Outcome direct = RunCommand(meeting.Command("fogline", what));
  EXPECT_EQ(json::parse(direct.out)["transport"], "direct");
  EXPECT_EQ(json::parse(direct.out)["rows"], json::parse(table.out)["rows"]);
}

TEST(DefaultUrlTest, IsNamedWhereItIsWrong) {
  for (const char* verb : {"top", "doctor", "spy"}) {
    const Outcome outcome =
        RunCommand({"env", "LCM_DEFAULT_URL=memq://", "DISPLAY=:0", Program("fogline"), verb});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("error: LCM_DEFAULT_URL memq://: other processes cannot "
                                       "look into the memory of a process"));
  }
  const Outcome run = RunCommand(
      {"env", "LCM_DEFAULT_URL=direct", Program("fogline"), "run", "scenario/paper.json"});
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.err,
            "fogline run: error: LCM_DEFAULT_URL direct: no LCM URL such as "
            "\"udpm://239.255.76.67:7667?ttl=0\"\n");
}

TEST(WaitTest, OfARunSaysWhatIsMissingAndWhatStartsItAndHasALimit) {
  Meeting meeting;
  const Outcome run = RunCommand(meeting.Run(
      {"--transport", "udpm", "--external", "driver", "--external", "acc", "--wait", "0.5"}));
  EXPECT_EQ(run.code, 3);
  const std::string url =
      run.err.substr(run.err.find(" on ") + 4, run.err.find('\n') - run.err.find(" on ") - 4);
  EXPECT_THAT(run.err, HasSubstr("waiting for the acc, the driver (0.5 s): start each with: "
                                 "fogline-ROLE --lcm-url '" +
                                 url + "'\n"));
  EXPECT_EQ(run.err.find("\n\n"), std::string::npos) << run.err;
  EXPECT_THAT(run.err, HasSubstr("fogline run: error: waited 0.5 s for the acc, the driver in "
                                 "vain; start with: fogline-acc --lcm-url '" +
                                 url + "' and fogline-driver --lcm-url '" + url + "' "));
}

TEST(WaitTest, OfARunIsAMinuteUnlessSaidOtherwise) {
  Meeting meeting;
  Background minute(meeting.Run({"--transport", "udpm", "--external", "driver"}));
  EXPECT_TRUE(minute.WaitForErr("waiting for the driver (60 s): ", kPatience)) << minute.Err();
  Background endless(meeting.Run({"--transport", "udpm", "--external", "acc", "--wait", "0"}));
  EXPECT_TRUE(endless.WaitForErr("waiting for the acc (for ever): ", kPatience)) << endless.Err();
  Background acc(meeting.Command("fogline-acc", {}));
  EXPECT_EQ(endless.Wait(), 0) << endless.Err() << acc.Err();
}

TEST(WaitTest, OfATableHasALimitToo) {
  const Meeting meeting;
  const Outcome table =
      RunCommand({Program("fogline"), "table", "scenario/paper.json", "--external", "driver",
                  "--lcm-url", meeting.url(), "--wait", "0.5"});
  EXPECT_EQ(table.code, 3);
  EXPECT_THAT(table.err, HasSubstr("each of 4 runs waits for the driver (0.5 s); start it for each "
                                   "run with: fogline-driver --lcm-url '" +
                                   meeting.url()));
  EXPECT_THAT(table.err, HasSubstr("fogline table: error: waited 0.5 s for the driver in vain"));
}

TEST(WaitTest, OfARoleHasALimitToo) {
  const std::string url = runtime::FreshMulticastUrl();
  const Outcome driver = RunCommand({Program("fogline-driver"), "--lcm-url", url, "--wait", "0.5"});
  EXPECT_EQ(driver.code, 3);
  const std::string how =
      "; start one with: fogline run SCENARIO --external driver --lcm-url '" + url + "'";
  EXPECT_EQ(driver.err, "fogline-driver: waiting for a run on " + url + how +
                            "\nfogline-driver: error: waited 0.5 s for a run on " + url +
                            " in vain" + how + " (--wait 0 waits for ever)\n");
}

TEST(WaitTest, OfARoleAndOfSpyIsAMinuteUnlessSaidOtherwise) {
  for (const std::vector<std::string>& command :
       {std::vector{Program("fogline-driver")},
        std::vector{Program("fogline"), std::string("spy")}}) {
    std::vector<std::string> help = command;
    help.emplace_back("--help");
    EXPECT_THAT(RunCommand(help).out, testing::ContainsRegex("\n  --wait [^\n]*=60\n"));
  }
}

TEST(WaitTest, OfARoleThatTheRunnerStartsIsSilent) {
  const Outcome role =
      RunCommand({Program("fogline-driver"), "--lcm-url", runtime::FreshMulticastUrl(), "--run-id",
                  "4711", "--wait", "0.2"});
  EXPECT_EQ(role.code, 3);
  EXPECT_THAT(role.err, testing::StartsWith("fogline-driver: error: waited 0.2 s for a run on "));
}

/// The lines of docs/network.md that a person copies to record a run with lcm-logger.
std::string LinesOfLogger() {
  for (const Block& block : BlocksOf(Content(SourceDirectory() / "docs/network.md"))) {
    if (block.text.find("lcm-logger ") != std::string::npos) return block.text;
  }
  return "";
}

TEST(DocsLinesTest, RecordARunWithLcmLoggerByTheLinesThatTheyShow) {
  // GIVEN the lines of docs/network.md, with a port that no other test has, and a run of three
  // seconds
  std::string lines = LinesOfLogger();
  const std::string port = "udpm://239.255.76.67:7700?ttl=0";
  ASSERT_THAT(lines, HasSubstr(port));
  lines.replace(lines.find(port), port.size(), runtime::FreshMulticastUrl());
  const std::string run = "fogline run scenario/paper.json";
  ASSERT_THAT(lines, HasSubstr(run));
  lines.insert(lines.find(run) + run.size(), " --set /steps=30 --log run.lcm");
  // WHEN a shell executes these lines in a folder of its own
  const ScratchFolder folder;
  std::filesystem::create_directory_symlink(SourceDirectory() / "scenario",
                                            folder.path() / "scenario");
  const Outcome shell =
      RunCommand({"bash", "-c",
                  "cd " + folder.path().string() + " && PATH=" + ProgramDirectory().string() +
                      ":$PATH\n" + lines + "\nkill -INT $!; wait"});
  // THEN lcm-logger has logged the steps that the run sent after lcm-logger had begun to listen
  log::EventLogReader log(folder.File("copy.lcm"));
  std::int64_t truths = 0;
  while (const auto event = log.Next()) truths += event->channel == "TRUTH" ? 1 : 0;
  EXPECT_GT(truths, 0) << shell.out << shell.err;
}

}  // namespace
}  // namespace fogline::test
