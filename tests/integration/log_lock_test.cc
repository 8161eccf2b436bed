// A log belongs to one run, and a folder of logs to one table, for as long as they write and read
// there.
#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "services/runtime/bus.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::vector<std::string> With(std::vector<std::string> command,
                              const std::vector<std::string>& more) {
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

bool HoldsALock(pid_t pid) {
  std::ifstream locks("/proc/locks");
  const std::string text{std::istreambuf_iterator<char>(locks), {}};
  return text.find(" " + std::to_string(pid) + " ") != std::string::npos;
}

class LogLockTest : public testing::Test {
 protected:
  /// A run into log_, or a table into its folder: it waits for a driver for as long as none comes.
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
  const std::string url_ = FreshMulticastUrl();
  const std::vector<std::string> run_{Program("fogline"), "run", "scenario/paper.json", "--log",
                                      log_};
};

TEST_F(LogLockTest, ASecondRunIntoOneLogIsRefusedByNameAndTheFirstKeepsItsResult) {
  // GIVEN a run that has yet to begin: its log may be empty still
  Background first(WaitingForADriver(With(run_, {"--json", "--seed", "1"})));
  ASSERT_TRUE(first.WaitForErr("waiting for the driver"));
  ExpectRefusalOfASecondRun(first.pid());
  // WHEN it goes on
  const Background driver(StartADriver());
  ASSERT_EQ(first.Wait(), 0) << first.Err();
  // THEN result and log are its own
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
  Background first(With(run_, {"--pace", "1"}));
  ASSERT_TRUE(first.WaitForErr("processes: "));
  ASSERT_TRUE(GrowsTo(1, log_));
  // WHEN it stands still with its recorder dead; THEN the log is its own nevertheless
  first.Signal(SIGSTOP);
  kill(PidOf(first.Err(), "recorder"), SIGKILL);
  ExpectRefusalOfASecondRun(first.pid());
  // AND the recorder that is started in its place goes on with it
  first.Signal(SIGCONT);
  ASSERT_TRUE(first.WaitForErr("started again as pid")) << first.Err();
  const auto size = std::filesystem::file_size(log_);
  EXPECT_TRUE(GrowsTo(size + 1, log_)) << first.Err();
  first.Signal(SIGINT);
  EXPECT_EQ(first.Wait(), 130);
  EXPECT_THAT(first.Err(), HasSubstr("the log so far: " + log_));
  // AND it is free in the end
  EXPECT_EQ(RunCommand(With(run_, {"--force", "--transport", "direct"})).code, 0);
}

TEST_F(LogLockTest, ARunInOneProcessLocksItsLogToo) {
  for (const char* transport : {"direct", "memq"}) {
    // GIVEN a run of a day that has begun, and stands still
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
                                          FreshMulticastUrl()};
  {
    Background run(WaitingForADriver(run_));
    ASSERT_TRUE(run.WaitForErr("waiting for the driver"));
    ASSERT_TRUE(GrowsTo(1, log_));
    const auto size = std::filesystem::file_size(log_);
    const Outcome refused = RunCommand(recorder);
    EXPECT_EQ(refused.code, 2);
    EXPECT_EQ(refused.err, "fogline-recorder: " + RefusalNaming(run.pid()));
    EXPECT_EQ(std::filesystem::file_size(log_), size) << "the log of the run is as it was";
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
  // GIVEN a run whose recorder has begun its log
  Background run(WaitingForADriver(With(run_, {"--json"})));
  ASSERT_TRUE(run.WaitForErr("waiting for the driver"));
  ASSERT_TRUE(GrowsTo(1, log_));
  // WHEN another log takes its place
  std::filesystem::rename(other, log_);
  const Background driver(StartADriver());
  // THEN the run fails, and reports nothing
  EXPECT_EQ(run.Wait(), 3);
  EXPECT_THAT(run.Err(), HasSubstr("fogline run: error: " + log_ + ": the log is that of run "));
  EXPECT_EQ(run.Out(), "");
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
  // A run may not take a log out of the folder either, but may have one of its own there.
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
  // GIVEN a run that waits in vain for its driver, with a scenario and no step in its log
  const Outcome run = RunCommand(With(WaitingForADriver(run_), {"--wait", "0.5"}));
  EXPECT_EQ(run.code, 3);
  EXPECT_THAT(run.err, HasSubstr("waited 0.5 s for the driver in vain"));
  EXPECT_THAT(run.err, HasSubstr("\n  no log was written\n"));
  EXPECT_FALSE(std::filesystem::exists(log_));
  // AND a recorder that waits in vain for a run
  const std::vector<std::string> recorder{Program("fogline-recorder"), "--log",  log_, "--lcm-url",
                                          FreshMulticastUrl(),         "--wait", "0.5"};
  EXPECT_EQ(RunCommand(recorder).code, 3);
  EXPECT_FALSE(std::filesystem::exists(log_));
  // AND an older log is as it was, where it would have been replaced
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
  // AND it is gone when the run has begun, with nothing beside the new one
  EXPECT_EQ(RunCommand(With(run_, {"--force", "--seed", "2"})).code, 0);
  EXPECT_NE(Content(log_), older);
  const std::filesystem::directory_iterator files(std::filesystem::path(log_).parent_path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST_F(LogLockTest, AnEmptyFileIsAsGoodAsNone) {
  std::ofstream(log_).flush();
  EXPECT_EQ(RunCommand(With(run_, {"--transport", "direct"})).code, 0);
}

TEST_F(LogLockTest, AnInterruptedRunSpeaksOfNoLogWhereThereIsNone) {
  // GIVEN a run whose recorder never learns what to record
  Background run(With(run_, {"--faults", "loss=0.999999"}));
  ASSERT_TRUE(run.WaitForErr("processes: "));
  run.Signal(SIGINT);
  EXPECT_EQ(run.Wait(), 130);
  EXPECT_THAT(run.Err(), HasSubstr("; no log was written\n"));
  EXPECT_FALSE(std::filesystem::exists(log_));
}

}  // namespace
}  // namespace fogline::test
