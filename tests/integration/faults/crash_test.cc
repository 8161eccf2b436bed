// Processes of a run are killed or hang. The run replaces them and has the same result, or it ends
// with one clear error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <random>
#include <thread>

#include "tests/integration/faults/killed_roles.h"
#include "tests/integration/faults/watched_run.h"
#include "tests/support/command.h"
#include "tests/support/machine.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

class CrashOfARoleTest : public testing::TestWithParam<std::string> {};

TEST_P(CrashOfARoleTest, ChangesNoResultAndIsReported) {
  const std::string& role = GetParam();
  // The step at which a role is killed depends only on the role's name, so this step is the same in
  // every execution.
  std::mt19937 random(static_cast<unsigned>(role.size() * 256 + static_cast<unsigned>(role[0])));
  const int step = std::uniform_int_distribution(80, 200)(random);
  WatchedRun watched;
  watched.WaitForStep(step);
  watched.Signal(role, SIGKILL);
  const auto result = watched.ExpectSameResult();
  ASSERT_EQ(result["restarts"].size(), 1U) << result["restarts"];
  EXPECT_EQ(WatchedRun::RestartsOf(result, role), 1);
  EXPECT_THAT(result["restarts"][0]["last"].get<std::string>(),
              HasSubstr("was killed by signal 9 (Killed) at step "));
  EXPECT_THAT(watched.run().Err(), HasSubstr("; started again as pid "));
}

INSTANTIATE_TEST_SUITE_P(EveryRole, CrashOfARoleTest, testing::ValuesIn(AllRoles()),
                         [](const auto& role) { return role.param; });

TEST(CrashTest, OfEveryRoleAtOnceChangesNoResult) {
  WatchedRun watched;
  watched.WaitForStep(150);
  for (const std::string& role : AllRoles()) watched.Signal(role, SIGKILL);
  const auto result = watched.ExpectSameResult();
  EXPECT_EQ(result["restarts"].size(), kRoles.size());
}

TEST(CrashTest, OfRolesThatReadEachOtherChangesNoResult) {
  // GIVEN a driver whose awareness depends on HOST_COMMAND, while the arbitrator reads
  // DRIVER_COMMAND
  WatchedRun watched({}, kSteps, kPace,
                     {"--set", "/human/loses_awareness=true", "--set", "/human/misjudges=true",
                      "--set", "/arbitrator/threshold=0.5", "--set", "/fog/start_s=5"});
  const std::vector<std::string> both{"driver", "arbitrator"};
  watched.WaitForStep(70);
  watched.Signal("driver", SIGKILL);
  watched.WaitForStep(120);
  watched.Signal("arbitrator", SIGKILL);
  watched.WaitForStep(190);
  for (const std::string& role : both) watched.Signal(role, SIGKILL);
  const auto result = watched.ExpectSameResult();
  for (const std::string& role : both) EXPECT_EQ(WatchedRun::RestartsOf(result, role), 2) << role;
}

TEST(CrashTest, OfARoleThatCatchesUpChangesNoResult) {
  WatchedRun watched;
  watched.WaitForStep(100);
  // Each new process is killed as soon as the test receives its first message. So the process may
  // be killed before, while or after it catches up with the run.
  for (int i = 0; i < 5; ++i) {
    for (const char* role : {"fusion", "recorder", "world"}) watched.Signal(role, SIGKILL);
  }
  const auto result = watched.ExpectSameResult();
  for (const char* role : {"fusion", "recorder", "world"}) {
    EXPECT_EQ(WatchedRun::RestartsOf(result, role), 5) << role;
  }
}

TEST(CrashTest, WhileTheRunIsJoinedIsRepairedToo) {
  // GIVEN a run that waits for a driver
  WatchedRun watched({"--external", "driver"});
  watched.WaitForState("radar", status_t::READY);
  // WHEN other processes are killed before the driver comes
  for (const char* role : {"radar", "world", "recorder"}) watched.Signal(role, SIGKILL);
  for (const char* role : {"radar", "world", "recorder"}) {
    watched.WaitForState(role, status_t::READY);
  }
  // THEN the driver joins, and the run has the result of an undisturbed run
  const Background driver({Program("fogline-driver"), "--lcm-url", watched.url()});
  const auto result = watched.ExpectSameResult();
  EXPECT_EQ(result["restarts"].size(), 3U);
}

TEST(CrashTest, ProcessesThatHangAreKilledAndStartedAgain) {
  ExpectHangersAreStartedAgain(AllRoles());
}

TEST(CrashTest, ARunnerThatWasHeldUpItselfTakesNoRoleForHung) {
  // GIVEN a runner that is stopped for 3.5 s in a run of 16 s. A role that sends nothing for 2 s
  // counts as hung, but the runner must not count the time of its own pause
  WatchedRun watched({"--stall-timeout", "6"}, 1600);
  watched.WaitForStep(100);
  kill(watched.run().pid(), SIGSTOP);
  std::this_thread::sleep_for(milliseconds(3500));  // the test is about this pause
  // WHEN the runner continues, THEN the run continues, too
  kill(watched.run().pid(), SIGCONT);
  const auto result = watched.ExpectSameResult();
  EXPECT_TRUE(result["restarts"].empty()) << result["restarts"];
  EXPECT_THAT(watched.run().Err(),
              testing::ContainsRegex(
                  "warning: the runner was held up for (3\\.[4-9]|[4-9]\\.[0-9]) s at step "));
}

TEST(CrashTest, EndsTheRunByNameWhenItHappensTooOften) {
  WatchedRun watched({"--restarts", "2"});
  watched.WaitForStep(100);
  for (int i = 0; i < 3; ++i) watched.Signal("fusion", SIGKILL);
  EXPECT_EQ(watched.run().Wait(), 3);
  EXPECT_THAT(watched.run().Err(), HasSubstr("error: fusion (pid "));
  EXPECT_THAT(watched.run().Err(), HasSubstr(", after 2 restarts (--restarts)\n"));
}

TEST(CrashTest, OfARoleFromElsewhereIsOverWhenItIsStartedAgain) {
  // GIVEN a run that lasts longer than the runner needs to notice the end of a role
  WatchedRun watched({"--external", "driver", "--stall-timeout", "30"}, 600);
  const std::vector<std::string> command{Program("fogline-driver"), "--lcm-url", watched.url()};
  const Background first(command);
  watched.WaitForStep(100);
  watched.Signal("driver", SIGKILL);
  // The second driver is started without --run-id. Only messages tell this driver the run id.
  const Background second(command);
  const auto result = watched.ExpectSameResult();
  ASSERT_EQ(WatchedRun::RestartsOf(result, "driver"), 1);
  EXPECT_THAT(result["restarts"][0]["last"].get<std::string>(), HasSubstr("fell silent at step "));
}

TEST(CrashTest, ASecondProcessOfARoleThatLivesIsRefusedAndToldAndTheRunGoesOn) {
  WatchedRun watched({}, 1200);
  watched.WaitForStep(100);
  const std::string ours = std::to_string(watched.PidOf("acc"));
  Background second(
      {Program("fogline-acc"), "--lcm-url", watched.url(), "--run-id", watched.RunId()});
  EXPECT_TRUE(
      watched.run().WaitForErr("warning: acc (pid " + std::to_string(second.pid()) + " on "));
  EXPECT_TRUE(watched.run().WaitForErr(" is refused: the acc of this run is pid " + ours + " on "));
  EXPECT_EQ(second.Wait(), 3);
  EXPECT_EQ(second.Err(),
            "fogline-acc: error: another process is the acc of run " + watched.RunId() + "\n");
  EXPECT_TRUE(watched.ExpectSameResult()["restarts"].empty());
}

TEST(CrashTest, AProcessOfARoleThatTheRunHasItselfWaitsForAnotherRun) {
  WatchedRun watched({}, 1200);
  watched.WaitForStep(100);
  // This second process waits for another run, because the run has its acc already. `--wait 0` sets
  // no limit for this wait. The usual limit is 60 s, and the run may last longer.
  Background stray({Program("fogline-acc"), "--lcm-url", watched.url(), "--wait", "0"});
  EXPECT_TRUE(stray.WaitForErr("fogline-acc: run " + watched.RunId() + " on " + watched.url()));
  EXPECT_TRUE(watched.ExpectSameResult()["restarts"].empty());
  EXPECT_TRUE(IsAlive(stray.pid()));
  EXPECT_THAT(stray.Err(), HasSubstr(" has its acc already; waiting for another run\n"));
}

TEST(CrashTest, ARoleFromElsewhereThatGoesOnAfterItWasReplacedLeavesTheRun) {
  // GIVEN a stopped driver, and a second driver that has replaced the first one
  WatchedRun watched({"--external", "driver", "--stall-timeout", "30"}, 1200);
  const std::vector<std::string> command{Program("fogline-driver"), "--lcm-url", watched.url()};
  Background first(command);
  watched.WaitForStep(100);
  first.Signal(SIGSTOP);
  Background second(command);
  watched.WaitUntil([&] { return watched.StateOf("driver", second.pid()) == status_t::RUNNING; },
                    "the other driver");
  // WHEN the first driver continues, THEN it leaves the run to the second driver
  first.Signal(SIGCONT);
  EXPECT_TRUE(first.WaitForErr("another process is the driver of run ")) << first.Err();
  // On a busy machine the second driver may get no processor time for 1 s. Then the first driver
  // would take the role again. So the test ends the first driver.
  first.Signal(SIGTERM);
  EXPECT_EQ(WatchedRun::RestartsOf(watched.ExpectSameResult(), "driver"), 1);
  EXPECT_EQ(second.Wait(), 0) << second.Err();
}

TEST(CrashTest, AFullDiskEndsTheRunByNameAndLeavesAReadableLog) {
  if (geteuid() != 0) return MachineLacks("root, to mount a small file system");
  if (const Outcome own = RunCommand({"unshare", "--mount", "true"}); own.code != 0) {
    return MachineLacks("mount namespaces: " + own.err);
  }
  const ScratchFolder folder;
  // A file system of 64 KiB has room for about fifty steps. It is mounted only for these two
  // commands.
  const Outcome outcome =
      RunCommand({"unshare", "--mount", "sh", "-c",
                  "mount -t tmpfs -o size=64k small \"$1\" || exit 99\n"
                  "\"$0\" run scenario/paper.json --quiet --log \"$1/run.lcm\"\ncode=$?\n"
                  "\"$0\" digest \"$1/run.lcm\"\nexit $code",
                  Program("fogline"), folder.path().string()});
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("error: recorder: cannot write to " + folder.File("run.lcm") +
                                     ": No space left on device\n"));
  EXPECT_THAT(outcome.err, HasSubstr("cut off after event "));
  EXPECT_THAT(outcome.out, testing::MatchesRegex("[0-9a-f]+ .*run.lcm\n"));
}

TEST(CrashTest, TheLimitForTheSizeOfFilesEndsTheRunByNameAndStartsNoRecorderAgain) {
  for (const char* transport : {"udpm", "memq", "direct"}) {
    SCOPED_TRACE(transport);
    const ScratchFolder folder;
    const std::string log = folder.File("run.lcm");
    // GIVEN a shell that limits the size of a file to 64 KiB, which is about fifty steps
    const Outcome outcome =
        RunCommand({"bash", "-c", "ulimit -f 64; exec \"$0\" run scenario/paper.json --log \"$@\"",
                    Program("fogline"), log, "--transport", transport});
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("cannot write to " + log +
                                       ": the file size limit of 65536 bytes is reached; "
                                       "ulimit -f unlimited lifts it\n  the log so far: " +
                                       log + "\n  to go on: fogline run --resume " + log));
    EXPECT_EQ(outcome.err.find("started again"), std::string::npos) << outcome.err;
    EXPECT_EQ(std::filesystem::file_size(log), 65'536U);
    // WHEN the limit is lifted, THEN the run continues
    const Outcome rest =
        RunCommand({Program("fogline"), "run", "--resume", log, "--transport", transport});
    EXPECT_EQ(rest.code, 0) << rest.err;
    EXPECT_THAT(rest.out, HasSubstr("digest 90ca471057e464ab"));
  }
}

TEST(CrashTest, AtRandomStepsChangesNoResult) { ExpectKillsAtRandomStepsChangeNoResult(6); }

}  // namespace
}  // namespace fogline::test
