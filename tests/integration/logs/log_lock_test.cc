// While a run writes its log, no other run may write this log. While a table writes its folder of
// logs, no other table may write there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/logs/log_integrity_fixture.h"
#include "tests/support/children.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string TextOf(const std::string& name) {
  std::ifstream file(name);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool HoldsALock(pid_t pid) {
  return TextOf("/proc/locks").find(" " + std::to_string(pid) + " ") != std::string::npos;
}

class LogLockTest : public testing::Test {
 protected:
  /// The command of a run into log_, or of a table into its folder, with an external driver. The
  /// run or table then waits for this driver.
  std::vector<std::string> WaitingForADriver(const std::vector<std::string>& command) const {
    return With(command, {"--external", "driver", "--lcm-url", url_});
  }
  std::vector<std::string> StartADriver() const {
    return {Program("fogline-driver"), "--lcm-url", url_};
  }
  std::string RefusalNaming(pid_t pid) const {
    return log_ + ": error: --log: is being written by another run (pid " + std::to_string(pid) +
           ")\n";
  }
  void ExpectRefusalOfASecondRun(pid_t owner) const {
    for (const char* transport : {"direct", "memq", "udpm"}) {
      const Outcome second =
          RunCommand(With(run_, {"--force", "--seed", "2", "--transport", transport, "--quiet"}));
      EXPECT_EQ(second.code, 2) << transport << ": " << second.out;
      EXPECT_EQ(second.err, RefusalNaming(owner)) << transport;
    }
    EXPECT_EQ(RunCommand(With(run_, {"--transport", "direct"})).err, RefusalNaming(owner))
        << "--force would not help";
  }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  const std::string url_ = runtime::FreshMulticastUrl();
  const std::vector<std::string> run_{Program("fogline"), "run", "scenario/paper.json", "--log",
                                      log_};
};

TEST_F(LogLockTest, ASecondRunIntoOneLogIsRefusedByNameAndTheFirstKeepsItsResult) {
  // GIVEN a run that waits for its driver, so its log may still be empty
  Background first(WaitingForADriver(With(run_, {"--json", "--seed", "1"})));
  ASSERT_TRUE(first.WaitForErr("waiting for the driver"));
  ExpectRefusalOfASecondRun(first.pid());
  // WHEN the run continues
  const Background driver(StartADriver());
  ASSERT_EQ(first.Wait(), 0) << first.Err();
  // THEN its result and its log are those of an undisturbed run
  const Outcome direct = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--json",
                                     "--transport", "direct", "--seed", "1"});
  const auto result = nlohmann::json::parse(first.Out());
  const auto expected = nlohmann::json::parse(direct.out);
  EXPECT_EQ(result["digest"], expected["digest"]);
  EXPECT_EQ(result["metrics"], expected["metrics"]);
  EXPECT_THAT(RunCommand({Program("fogline"), "digest", log_}).out,
              HasSubstr(expected["digest"].get<std::string>()));
}

TEST_F(LogLockTest, ALogStaysLockedWhileItsRunStandsStillAndWhileItsRecorderIsStartedAgain) {
  // GIVEN a run that is under way
  Background first(With(run_, {"--pace", "5", "--stall-timeout", "30"}));
  ASSERT_TRUE(first.WaitForErr("processes: "));
  ASSERT_TRUE(GrowsTo(1, log_));
  // WHEN the run is stopped and its recorder is killed, THEN other runs still may not write the log
  first.Signal(SIGSTOP);
  kill(PidOf(first.Err(), "recorder"), SIGKILL);
  ExpectRefusalOfASecondRun(first.pid());
  // AND the next recorder continues the log to its end
  first.Signal(SIGCONT);
  EXPECT_EQ(first.Wait(), 0);
  EXPECT_THAT(first.Err(), HasSubstr("started again as pid"));
  const Outcome digest = RunCommand({Program("fogline"), "digest", log_});
  EXPECT_EQ(digest.code, 0) << digest.err;
  // AND the log is free after the run
  EXPECT_EQ(RunCommand(With(run_, {"--force", "--transport", "direct"})).code, 0);
}

TEST_F(LogLockTest, ARunInOneProcessLocksItsLogToo) {
  for (const char* transport : {"direct", "memq"}) {
    // GIVEN a run of a simulated day that has begun and is then stopped
    Background first(With(run_, {"--transport", transport, "--set", "/steps=1000000"}));
    ASSERT_TRUE(GrowsTo(1, log_)) << first.Err();
    first.Signal(SIGSTOP);
    ExpectRefusalOfASecondRun(first.pid());
    first.Signal(SIGINT);
    first.Signal(SIGCONT);
    EXPECT_EQ(first.Wait(), 130) << first.Err();
    std::filesystem::remove(log_);
  }
}

TEST_F(LogLockTest, ARecorderThatIsStartedByHandTakesNoLogOfARunAndLocksItsOwn) {
  const std::vector<std::string> recorder{Program("fogline-recorder"), "--log", log_, "--lcm-url",
                                          runtime::FreshMulticastUrl()};
  {
    Background run(WaitingForADriver(run_));
    ASSERT_TRUE(run.WaitForErr("waiting for the driver"));
    ASSERT_TRUE(GrowsTo(1, log_));
    const std::string before = TextOf(log_);
    const Outcome refused = RunCommand(recorder);
    EXPECT_EQ(refused.code, 2);
    EXPECT_EQ(refused.err, "fogline-recorder: " + RefusalNaming(run.pid()));
    // The run's own recorder may have written more, so the log may be longer than before.
    EXPECT_TRUE(TextOf(log_).starts_with(before)) << "the log of the run is as it was";
  }
  std::filesystem::remove(log_);
  const Background alone(recorder);
  while (!HoldsALock(alone.pid())) ASSERT_TRUE(IsAlive(alone.pid())) << alone.Err();
  ExpectRefusalOfASecondRun(alone.pid());
  EXPECT_TRUE(std::filesystem::exists(log_)) << "a run that is refused removes no empty log";
}

TEST_F(LogLockTest, ARunRefusesALogThatIsNotItsOwn) {
  const std::string other = folder_.File("other.lcm");
  ASSERT_EQ(RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                        "--seed", "2", "--log", other})
                .code,
            0);
  // GIVEN a run with a log that its recorder has begun
  Background run(WaitingForADriver(With(run_, {"--json"})));
  ASSERT_TRUE(run.WaitForErr("waiting for the driver"));
  ASSERT_TRUE(GrowsTo(1, log_));
  // WHEN another log replaces this log
  std::filesystem::rename(other, log_);
  const Background driver(StartADriver());
  // THEN the run fails and reports no result
  EXPECT_EQ(run.Wait(), 3);
  EXPECT_THAT(run.Err(), HasSubstr("fogline run: error: " + log_ + ": the log is of run "));
  EXPECT_EQ(run.Out(), "");
}

TEST_F(LogLockTest, AnOpenFileOfTheProcessIsNoLog) {
  const std::string link = folder_.File("link.lcm");
  std::filesystem::create_symlink("/dev/stdout", link);
  for (const std::string& log :
       {std::string("/dev/stdout"), std::string("/proc/self/fd/1"), link}) {
    const Outcome run = RunCommand(
        {Program("fogline"), "run", "scenario/paper.json", "--transport", "direct", "--log", log});
    EXPECT_EQ(run.code, 2) << log << run.err;
    EXPECT_THAT(run.err, HasSubstr(log + ": error: --log: "));
  }
  EXPECT_TRUE(std::filesystem::is_symlink(link));
}

TEST_F(LogLockTest, ASecondTableIntoOneFolderIsRefusedByName) {
  const std::string logs = folder_.File("logs");
  const std::vector<std::string> table{
      Program("fogline"), "table", "scenario/paper.json", "--thresholds", "0.5", "--logs", logs};
  Background first(WaitingForADriver(table));
  ASSERT_TRUE(first.WaitForErr("for the driver"));
  ASSERT_TRUE(GrowsTo(1, logs + "/paper-seed1-threshold-none.lcm")) << first.Err();
  for (const char* transport : {"direct", "udpm"}) {
    const Outcome second = RunCommand(With(table, {"--transport", transport}));
    EXPECT_EQ(second.code, 2) << second.out;
    EXPECT_EQ(second.err, logs + ": error: --logs: is being written by another table (pid " +
                              std::to_string(first.pid()) + ")\n");
  }
  // A run may not replace a log that `fogline table` writes, but it may write a log of its own into
  // the same folder.
  const std::vector<std::string> run{
      Program("fogline"), "run",  "scenario/paper.json", "--transport", "direct",
      "--force",          "--log"};
  const std::string its = logs + "/paper-seed1-threshold-none.lcm";
  EXPECT_THAT(RunCommand(With(run, {its})).err,
              StartsWith(its + ": error: --log: is being written by another run (pid "));
  EXPECT_EQ(RunCommand(With(run, {logs + "/mine.lcm"})).code, 0);
  first.Signal(SIGINT);
  EXPECT_EQ(first.Wait(), 130) << first.Err();
  EXPECT_EQ(RunCommand(With(table, {"--transport", "direct"})).code, 0) << "free in the end";
}

TEST_F(LogLockTest, OfRunsThatBeginAtOnceIntoOneLogOneHasIt) {
  constexpr int kRuns = 6;
  for (int round = 0; round < 15; ++round) {
    std::filesystem::remove(log_);
    std::vector<std::unique_ptr<Background>> runs;
    for (int i = 0; i < kRuns; ++i) {
      runs.push_back(std::make_unique<Background>(
          With(run_, {"--transport", "direct", "--set", "/steps=10"})));
    }
    int done = 0;
    for (const auto& run : runs) done += run->Wait() == 0 ? 1 : 0;
    ASSERT_EQ(done, 1) << "round " << round;
    EXPECT_GT(std::filesystem::file_size(log_), 0U);
  }
}

TEST_F(LogLockTest, NothingStaysOfARunThatNeverBegan) {
  // GIVEN a run whose driver does not come. Its log would have a scenario, but no step
  const Outcome run = RunCommand(With(WaitingForADriver(run_), {"--wait", "0.5"}));
  EXPECT_EQ(run.code, 3);
  EXPECT_THAT(run.err, HasSubstr("waited 0.5 s for the driver in vain"));
  EXPECT_THAT(run.err, HasSubstr("\n  no log was written\n"));
  EXPECT_FALSE(std::filesystem::exists(log_));
  // AND a recorder whose run does not begin leaves no log
  const std::vector<std::string> recorder{Program("fogline-recorder"),  "--log",  log_, "--lcm-url",
                                          runtime::FreshMulticastUrl(), "--wait", "0.5"};
  EXPECT_EQ(RunCommand(recorder).code, 3);
  EXPECT_FALSE(std::filesystem::exists(log_));
  // AND a recorder whose run does not begin does not change an older log
  ASSERT_EQ(RunCommand(With(run_, {"--transport", "direct"})).code, 0);
  const auto size = std::filesystem::file_size(log_);
  EXPECT_EQ(RunCommand(recorder).code, 3);
  EXPECT_EQ(std::filesystem::file_size(log_), size);
}

TEST_F(LogLockTest, AnOlderLogIsThereAgainWhenTheRunThatReplacesItNeverBegins) {
  ASSERT_EQ(RunCommand(With(run_, {"--transport", "direct"})).code, 0);
  const std::string older = Content(log_);
  const std::vector<std::string> replace =
      With(WaitingForADriver(run_), {"--wait", "0.5", "--force"});
  EXPECT_EQ(RunCommand(replace).code, 3);
  EXPECT_EQ(Content(log_), older);
  // AND the older log is gone when the run has begun, and no other file lies beside the new log
  EXPECT_EQ(RunCommand(With(run_, {"--force", "--seed", "2"})).code, 0);
  EXPECT_NE(Content(log_), older);
  const std::filesystem::directory_iterator files(std::filesystem::path(log_).parent_path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

/// Ends a run by kill -9, and waits until its processes have ended, too.
void Kill(Background& run) {
  const std::vector<pid_t> children = ChildrenOf(run.pid());
  run.Signal(SIGKILL);
  EXPECT_EQ(run.Wait(), 128 + SIGKILL);
  for (const pid_t child : children) {
    while (IsAlive(child)) std::this_thread::sleep_for(kLookEvery);
  }
}

std::ptrdiff_t FilesBeside(const std::string& file) {
  const std::filesystem::directory_iterator files(std::filesystem::path(file).parent_path());
  return std::distance(begin(files), end(files));
}

TEST_F(LogLockTest, AKilledRunThatHasBegunToReplaceALogLeavesNoFileBesideIt) {
  for (const char* transport : {"udpm", "memq"}) {
    ASSERT_EQ(RunCommand(With(run_, {"--transport", "direct", "--force"})).code, 0);
    const std::string older = Content(log_);
    Background run(With(run_, {"--force", "--seed", "2", "--transport", transport, "--pace", "1"}));
    // GIVEN a new log with a step
    for (std::string log = older; log == older || log.find("TRUTH") == std::string::npos;
         log = Content(log_)) {
      ASSERT_TRUE(IsAlive(run.pid())) << run.Err();
      std::this_thread::sleep_for(kLookEvery);
    }
    // THEN the older log is removed while the run continues, long before the end of the run
    while (FilesBeside(log_) > 1) {
      ASSERT_TRUE(IsAlive(run.pid())) << transport << ": " << run.Err();
      std::this_thread::sleep_for(kLookEvery);
    }
    ASSERT_TRUE(IsAlive(run.pid())) << transport << ": removed by the run's end";
    Kill(run);
    EXPECT_EQ(FilesBeside(log_), 1) << transport;
    // AND the incomplete new log can be resumed
    const Outcome resumed = RunCommand({Program("fogline"), "run", "--resume", log_});
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_THAT(resumed.out, HasSubstr("500 steps"));
    EXPECT_EQ(FilesBeside(log_), 1) << transport;
  }
}

TEST_F(LogLockTest, AnOlderLogIsBackAfterAKillBeforeTheRunHasBegun) {
  ASSERT_EQ(RunCommand(With(run_, {"--transport", "direct"})).code, 0);
  const std::string older = Content(log_);
  const std::string back = log_ +
                           ": the older log is back: the run that was to replace it was "
                           "killed before its first step\n";
  const auto kill_early = [this] {
    Background run(WaitingForADriver(With(run_, {"--force"})));
    ASSERT_TRUE(run.WaitForErr("waiting for the driver"));
    Kill(run);
  };
  // WHEN another run is told to write this log, THEN that run finds the older log
  kill_early();
  ASSERT_NE(Content(log_), older);
  const Outcome second = RunCommand(With(run_, {"--transport", "direct"}));
  EXPECT_EQ(second.code, 2);
  EXPECT_EQ(second.err, back + log_ + ": error: --log: the file exists; --force replaces it\n");
  EXPECT_EQ(Content(log_), older);
  EXPECT_EQ(FilesBeside(log_), 1);
  // AND --resume finds the older log, too
  kill_early();
  const Outcome resumed = RunCommand({Program("fogline"), "run", "--resume", log_});
  EXPECT_EQ(resumed.code, 0);
  EXPECT_THAT(resumed.err, StartsWith(back));
  EXPECT_EQ(Content(log_), older);
  EXPECT_EQ(FilesBeside(log_), 1);
}

TEST_F(LogLockTest, AnEmptyFileIsAsGoodAsNone) {
  std::ofstream(log_).flush();
  EXPECT_EQ(RunCommand(With(run_, {"--transport", "direct"})).code, 0);
}

TEST_F(LogLockTest, AnInterruptedRunSpeaksOfNoLogWhereThereIsNone) {
  // GIVEN a run in which the recorder never gets the scenario
  Background run(With(run_, {"--faults", "loss=0.999999"}));
  ASSERT_TRUE(run.WaitForErr("processes: "));
  run.Signal(SIGINT);
  EXPECT_EQ(run.Wait(), 130);
  EXPECT_THAT(run.Err(), HasSubstr("; no log was written\n"));
  EXPECT_FALSE(std::filesystem::exists(log_));
}

}  // namespace
}  // namespace fogline::test
