// Sessions of `fogline experiment run` that are refused, and the checks before a run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/file_lock.h"
#include "tests/integration/experiment/experiment_fixture.h"
#include "tests/support/command.h"
#include "tests/support/machine.h"
#include "tests/support/network.h"
#include "tests/unit/tools/trials/desk/taken_port.h"

namespace fogline::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class RefusedSessionRealtimeTest : public ExperimentFixture {};

TEST_F(RefusedSessionRealtimeTest, ATitleThatNoLogCanHoldIsRefusedBeforeTheFirstRun) {
  auto plan = nlohmann::json::parse(Content(file_));
  std::string title;
  for (int i = 0; i < 60; ++i) title += "\u00e4";  // two bytes each
  plan["title"] = title;
  std::ofstream(file_) << plan.dump(2);
  const Outcome outcome = RunCommand(Session(1));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr(file_), HasSubstr("/title: \"\u00e4"),
                                 HasSubstr("has 120 bytes; at most 100 are allowed")));
  EXPECT_FALSE(std::filesystem::exists(results_));
}

TEST_F(RefusedSessionRealtimeTest, WrongArgumentsAreRefused) {
  const Outcome none = Experiment("run", {"--participant", "5"});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("the experiment has participants 1 to 4"));
  const Outcome direct = Experiment("run", {"--participant", "1", "--transport", "direct"});
  EXPECT_EQ(direct.code, 2);
  EXPECT_THAT(direct.err, HasSubstr("a trial needs a process for each role"));
}

TEST_F(RefusedSessionRealtimeTest, WhatASessionNeedsIsCheckedBeforeAnythingIsWritten) {
  const auto refused = [this](const std::vector<std::string>& more, int code,
                              const std::string& why) {
    std::vector<std::string> words{"--participant", "1"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = Experiment("run", words);
    EXPECT_EQ(outcome.code, code) << why;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, testing::StartsWith("fogline experiment run: error: " + why));
    EXPECT_FALSE(std::filesystem::exists(results_)) << why;
  };
  const std::string key = folder_.File("lab.key");
  ASSERT_EQ(RunCommand({Program("fogline"), "keygen", key}).code, 0);
  refused({"--faults", "flip=0.1"}, 2, "--faults: truncate and flip need --key");
  refused({"--lcm-url", "udpm://239.255.76.67:7700?ttl=x"}, 2,
          "--lcm-url udpm://239.255.76.67:7700?ttl=x: ttl is \"x\"");
  refused({"--lcm-url", "tcpq://127.0.0.1:1"}, 3, "no process listens on 127.0.0.1:1");
  refused({"--lcm-url", "mpudpm://239.1.1.1:7700?ttl=0", "--key", key}, 2,
          "--key: mpudpm has no filter");
  refused({"--evdev", "/dev/null", "--speed", "1"}, 2, "--evdev /dev/null: no input device");
  refused({"--listen", "203.0.113.7"}, 2, "--listen: 203.0.113.7 is no address of this machine");
  TakenPort taken(0);
  ASSERT_TRUE(taken.Take());
  const std::string port = std::to_string(taken.port());
  refused({"--participant-port", port}, 2, "--participant-port " + port + ": cannot listen on");
}

TEST_F(RefusedSessionRealtimeTest, WrongSpeedsAndFoldersAreRefused) {
  for (const char* action : {"status", "export"}) {
    const std::string out = folder_.File("no tables");
    const Outcome outcome =
        Experiment(action, action == std::string("export") ? std::vector<std::string>{"--out", out}
                                                           : std::vector<std::string>{});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(results_ + ": error: --results: there is no such folder"));
    EXPECT_FALSE(std::filesystem::exists(out));
  }
  const Outcome fast = Experiment("run", {"--participant", "1", "--no-page", "--speed", "1000"});
  EXPECT_EQ(fast.code, 2);
  EXPECT_THAT(fast.err,
              HasSubstr("error: --speed 1000: in condition \"low\": a step of 0.1 s would "
                        "take 0.1 ms"));
  const Outcome driven = Experiment("run", {"--participant", "1", "--keys"});
  EXPECT_EQ(driven.code, 2);
  EXPECT_THAT(driven.err, HasSubstr("error: --keys: a person drives at speed 1, but /speed of " +
                                    file_ + " is 10; give --speed 1"));
  const Outcome device = Experiment("run", {"--participant", "1", "--evdev", "/dev/null"});
  EXPECT_EQ(device.code, 2);
  EXPECT_THAT(device.err, HasSubstr("error: --evdev /dev/null: a person drives at speed 1, but"));
  EXPECT_FALSE(std::filesystem::exists(results_));
}

TEST_F(RefusedSessionRealtimeTest, ASecondSessionOfAParticipantIsToldSoEvenIfThePortIsTaken) {
  ASSERT_EQ(RunCommand(Session(1)).code, 0);
  const std::filesystem::path folder = std::filesystem::path(results_) / "participant-01";
  const FileLock lock(folder, FileLock::Kind::kOwn, "--participant", "session");
  TakenPort taken(0);
  ASSERT_TRUE(taken.Take());
  const Outcome second =
      Experiment("run", {"--participant", "1", "--participant-port", std::to_string(taken.port())});
  EXPECT_EQ(second.code, 2);
  EXPECT_THAT(second.err, HasSubstr(folder.string() + ": error: --participant: is being written "
                                                      "by another session"));
}

TEST_F(RefusedSessionRealtimeTest, TheUsualNetworkIsAlsoCheckedBeforeAnythingIsWritten) {
  if (const std::string why = WhyNoMachines(); !why.empty())
    return MachineLacks("root, network namespaces or nftables: " + why);
  const Machine lonely("lab1");
  lonely.Do("ip link set lo down");
  const Outcome outcome =
      RunCommand(lonely.On({Program("fogline"), "experiment", "run", file_, "--results", results_,
                            "--participant", "1", "--no-page"}));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("Network is unreachable"));
  EXPECT_EQ(outcome.out, "");
  EXPECT_FALSE(std::filesystem::exists(results_));
}

TEST_F(RefusedSessionRealtimeTest, ASessionThatHasNothingToDriveNeedsNoNetwork) {
  ASSERT_EQ(RunCommand(Session(1)).code, 0);
  const Outcome outcome =
      Experiment("run", {"--participant", "1", "--no-page", "--lcm-url", "tcpq://127.0.0.1:1"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("participant 1: all trials are done; 0 runs now"));
}

TEST_F(RefusedSessionRealtimeTest, WithoutStdinASessionEndsTheLineOfItsPromptAndSaysWhy) {
  const Outcome outcome = Experiment("run", {"--participant", "1", "--no-page"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.out, testing::EndsWith("Enter begins it: \n"));
  EXPECT_THAT(outcome.err, HasSubstr("error: standard input has ended before the last answer"));
}

TEST_F(RefusedSessionRealtimeTest, AnEmptyTextIsRefused) {
  const Outcome outcome = Experiment("export", {"--out", ""});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("fogline experiment export: error: --out: the text is empty"));
}

}  // namespace
}  // namespace fogline::test
