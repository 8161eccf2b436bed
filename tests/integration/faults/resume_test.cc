// A run continues from its log after its runner was killed or interrupted: `fogline run --resume`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <fstream>

#include "services/graph.h"
#include "services/log/event_log.h"
#include "services/runtime/wire/scenario_parts.h"
#include "tests/integration/faults/resume_fixture.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

TEST_F(ResumeAfterKillTest, RunnersKilledAtRandomStepsChangeNoResult) {
  ExpectKilledRunnersChangeNoResult(3);
}

TEST_F(ResumeAfterKillTest, RunsInOneProcessGoOnToTheSameResult) {
  ExpectKilledProcessesGoOnToTheSameResult(3);
}

TEST_F(ResumeTest, GoesOnOverAnotherTransportThanItBeganWith) {
  const auto whole = Undisturbed();
  for (const char* transport : {"direct", "memq", "tcpq"}) {
    std::filesystem::remove(log_);
    SeenRun(Paper(kResumeSteps) + kPaced, log_).KillAtStep(50);
    EXPECT_EQ(ExpectSameEnd(whole, {"--transport", transport})["transport"], transport);
  }
}

TEST_F(ResumeTest, GoesOnAfterItHasBeenKilledWhileItWentOn) {
  const auto whole = Undisturbed();
  SeenRun(Paper(kResumeSteps) + kPaced, log_).KillAtStep(50);
  for (int i = 0; i < 2; ++i) {
    const auto size = std::filesystem::file_size(log_);
    Background again(Words{Program("fogline"), "run", "--resume", log_} + kPaced);
    ASSERT_TRUE(GrowsTo(size + 50'000, log_)) << again.Err();
    again.Signal(SIGKILL);
    again.Wait();
  }
  ExpectSameEnd(whole);
}

TEST_F(ResumeTest, RefusesNoMessageOfARunThatGoesOnUndisturbed) {
  const auto whole = Undisturbed();
  SeenRun(Paper(kResumeSteps) + kPaced, log_).KillAtStep(100);
  const auto result = ExpectSameEnd(whole);
  for (const auto& [kind, count] : result["refused"].items()) EXPECT_EQ(count, 0) << kind;
  EXPECT_EQ(result["verified"]["roles"].size(), kRoles.size() - 1);
}

TEST_F(ResumeTest, GoesOnWithTheRolesFromElsewhereThatHaveOutlivedTheirRunner) {
  const auto whole = Undisturbed();
  const std::string key = File("key");
  ASSERT_EQ(RunCommand({Program("fogline"), "keygen", key}).code, 0);
  for (const Words& sealed : {Words{}, Words{"--key", key}}) {
    std::filesystem::remove(log_);
    // GIVEN a driver that was started from another shell. An undisturbed run would last 15 s, so
    // that even on a busy machine the test kills the runner before the end of the run
    SeenRun seen(Paper(kResumeSteps) + Words{"--pace", "2", "--external", "driver"} + sealed, log_);
    Background driver(Words{Program("fogline-driver"), "--lcm-url", seen.url()} + sealed);
    // WHEN the runner is killed, THEN the same driver continues with the next runner
    seen.KillAtStep(150);
    ASSERT_TRUE(IsAlive(driver.pid()));
    const auto result =
        ExpectSameEnd(whole, Words{"--external", "driver", "--lcm-url", seen.url()} + sealed);
    EXPECT_EQ(result["restarts"].size(), 0U);
    EXPECT_EQ(driver.Wait(), 0) << driver.Err();
  }
}

TEST_F(ResumeTest, IsSaidWhereARunIsInterruptedOrFails) {
  const auto whole = Undisturbed();
  const std::string command = "\n  to go on: fogline run --resume " + log_;
  const std::string path = "PATH=" + ProgramDirectory().string() + ":$PATH ";
  {
    SeenRun seen(Paper(kResumeSteps) + kPaced, log_);
    seen.WaitForStep(100);
    seen.run().Signal(SIGINT);
    ASSERT_EQ(seen.run().Wait(), 130);
    EXPECT_THAT(seen.run().Err(), HasSubstr("; the log so far: " + log_ + command + " --lcm-url '" +
                                            seen.url() + "' --pace 4\n"));
  }
  {
    const std::string options =
        " --transport udpm --pace 10 --stall-timeout 5.5 --restarts 0 --wait 7.25 --same-build "
        "--no-verify";
    Background again({"sh", "-c",
                      "export " + path + "LCM_DEFAULT_URL='udpm://239.255.76.99:7699?ttl=0';" +
                          "exec fogline run --resume " + log_ + options});
    ASSERT_TRUE(again.WaitForErr("processes: "));
    kill(PidOf(again.Err(), "fusion"), SIGKILL);
    ASSERT_EQ(again.Wait(), 3);
    EXPECT_THAT(again.Err(), HasSubstr("\n  the log so far: " + log_ + command + options + "\n"));
  }
  // WHEN a person enters the command that the run printed, THEN the run continues
  const Outcome outcome = RunCommand({"sh", "-c", path + "fogline run --resume " + log_});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("digest " + whole["digest"].get<std::string>() + "\n"));
  EXPECT_THAT(outcome.out,
              ContainsRegex("^" + log_ + ": 300 steps, [0-9]+ of them from the log in "));
}

TEST_F(ResumeTest, NamesWhatTheLogHasAndIsSaidAgain) {
  const Words resume{Program("fogline"), "run", "--resume", log_};
  const auto refusal = [](const std::string& what) {
    return "fogline run: error: " + what +
           ": --resume goes on with the scenario and the log of its run (see fogline run --help)\n";
  };
  ExpectRefusal(resume + Words{"scenario/paper.json"}, refusal("SCENARIO"));
  ExpectRefusal(resume + Words{"--seed", "2"}, refusal("--seed"));
  ExpectRefusal(resume + Words{"--set", "/seed=2"}, refusal("--set"));
  ExpectRefusal(resume + Words{"--log", File("other.lcm")}, refusal("--log"));
  ExpectRefusal(resume + Words{"--force"}, refusal("--force"));
  ExpectRefusal(resume + Words{"--realtime"},
                "fogline run: error: --realtime: a run in real time cannot be resumed (see fogline "
                "run --help)\n");
  ExpectRefusal({Program("fogline"), "run"},
                "fogline run: error: SCENARIO is required (see fogline run --help)\n");
}

TEST_F(ResumeTest, RefusesWhatIsNoLogOfARun) {
  ExpectRefusal({Program("fogline"), "run", "--resume", log_},
                log_ + ": error: cannot read the log: No such file or directory\n");
  EXPECT_FALSE(std::filesystem::exists(log_));
  std::ofstream(log_) << "precious";
  ExpectRefusal({Program("fogline"), "run", "--resume", log_},
                log_ + ": error: not an LCM event log\n");
  std::ofstream(log_, std::ios::trunc).flush();
  ExpectRefusal("the log does not begin with the scenario of a run: start a new run");
  EXPECT_TRUE(std::filesystem::exists(log_));
}

TEST_F(ResumeTest, RefusesARunInRealTime) {
  {
    Background run(
        Words{Program("fogline"), "run", "scenario/paper.json", "--realtime", "--log", log_});
    ASSERT_TRUE(GrowsTo(50'000, log_)) << run.Err();
    run.Signal(SIGINT);
    ASSERT_EQ(run.Wait(), 130);
    EXPECT_EQ(run.Err().find("--resume"), std::string::npos) << run.Err();
  }
  ExpectRefusal("a run in real time cannot be resumed; only runs in lockstep can");
}

TEST_F(ResumeTest, RefusesTheLogOfARunThatIsUnderWay) {
  Background run(Paper(kResumeSteps) + Words{"--pace", "1", "--log", log_});
  ASSERT_TRUE(GrowsTo(20'000, log_)) << run.Err();
  const Outcome outcome = Resume();
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, log_ + ": error: --resume: is being written by another run (pid " +
                             std::to_string(run.pid()) + ")\n");
  EXPECT_TRUE(IsAlive(run.pid()));
}

TEST_F(ResumeTest, CutsNothingOffALogThatSomethingElseHasWritten) {
  Undisturbed();
  // GIVEN the log of a run in lockstep. This log contains a STATUS message. lcm-logger writes such
  // logs, and fogline run does not
  status_t status{};
  status.header.run_id = 1;
  std::vector<std::uint8_t> encoded;
  runtime::Encode(status, encoded);
  Copy(File("whole.lcm"), log_,
       [&](log::EventLogWriter& log, const log::Event& event,
           const std::vector<std::uint8_t>& data) {
         const bool is_step_17 = runtime::ReadInt64(data, runtime::kStepOffset) == 17;
         if (is_step_17 && event.channel == "TRUTH") log.Write("STATUS", 0, encoded);
         return runtime::ReadInt64(data, runtime::kStepOffset) < 250;
       });
  log::EventLogReader reader(log_);
  std::size_t at = 0;
  while (reader.Next()->channel != "STATUS") at = reader.good_bytes();
  ExpectRefusal("an event on channel STATUS (byte " + std::to_string(at) +
                ") does not continue step 16: fogline run does not leave a log like this");
}

TEST_F(ResumeTest, NamesTheRoleThatIsNotTheOneWhichWasRecorded) {
  Undisturbed();
  // GIVEN a log in which a command of the driver was altered
  Copy(File("whole.lcm"), log_,
       [](log::EventLogWriter&, const log::Event& event, std::vector<std::uint8_t>& data) {
         const std::int64_t step = runtime::ReadInt64(data, runtime::kStepOffset);
         if (step == 190 && event.channel == "DRIVER_COMMAND") data[runtime::kHeaderEnd + 7] ^= 1;
         return step < 200;
       });
  const Outcome direct = Resume({"--transport", "direct"});
  EXPECT_EQ(direct.code, 2);
  EXPECT_EQ(direct.err, log_ +
                            ": error: --resume: step 190: DRIVER_COMMAND differs from what driver "
                            "computes here: the log was made by another program, or another "
                            "version\n");
  for (const char* transport : {"memq", "udpm"}) {
    const Outcome outcome = Resume({"--transport", transport});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err,
                HasSubstr("error: recorder: step 190: DRIVER_COMMAND differs from the log: driver "
                          "is not the program or version that was recorded\n"));
  }
}

}  // namespace
}  // namespace fogline::test
