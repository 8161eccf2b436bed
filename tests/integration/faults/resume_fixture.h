// Runs that continue from their logs (`fogline run --resume`), in tests.
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "services/runtime/wire/message_signer.h"
#include "tests/support/command.h"
#include "tests/support/copied_log.h"

namespace fogline::test {

using Words = std::vector<std::string>;

inline Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// Steps of a run. Most runs over the network have the pace 4 (kPaced), at which a step takes 25 ms.
// So a test on a busy machine can still kill the run in its middle.
inline constexpr int kResumeSteps = 300;

class ResumeTest : public testing::Test {
 protected:
  static Words Paper(int steps) {
    return {Program("fogline"), "run",   "scenario/paper.json",
            "--json",           "--set", "/steps=" + std::to_string(steps)};
  }
  /// The result of an undisturbed run. The log of this run is whole.lcm.
  nlohmann::json Undisturbed(int steps = kResumeSteps) const {
    const Outcome outcome = RunCommand(
        Paper(steps) + Words{"--transport", "direct", "--force", "--log", File("whole.lcm")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }
  Outcome Resume(const Words& more = {}) const {
    return RunCommand(Words{Program("fogline"), "run", "--json", "--resume", log_} + more);
  }
  /// Resumes the run to its end. @return the result, which must be that of the undisturbed run
  nlohmann::json ExpectSameEnd(const nlohmann::json& whole, const Words& more = {}) const {
    const Outcome outcome = Resume(more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const auto result = nlohmann::json::parse(outcome.out, nullptr, false);
    EXPECT_EQ(result.value("digest", ""), whole["digest"]) << outcome.err;
    EXPECT_EQ(result.value("steps", 0), whole["steps"]);
    EXPECT_EQ(result.value("seed", 0), whole["seed"]);
    EXPECT_EQ(result["metrics"], whole["metrics"]);
    // The resumed log has the same events as whole.lcm and no others. Only the run ids differ. With
    // a key, the last event has a signature.
    const bool is_signed = std::ranges::find(more, "--key") != more.end();
    EXPECT_EQ(std::filesystem::file_size(log_), std::filesystem::file_size(File("whole.lcm")) +
                                                    (is_signed ? runtime::kSignatureBytes : 0));
    return result;
  }
  /// Kills the runner, not its roles, as soon as the log has `bytes` bytes.
  /// @return false if the runner had ended by itself before
  bool KillAt(std::uintmax_t bytes, const Words& command) const {
    Background run(command + Words{"--log", log_});
    EXPECT_TRUE(GrowsTo(bytes, log_)) << run.Err();
    run.Signal(SIGKILL);
    return run.Wait() == 128 + SIGKILL;
  }
  /// Expects that the command is refused with this text, and that the log stays unchanged.
  void ExpectRefusal(const Words& command, const std::string& err) const {
    const std::string before = Content(log_);
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    EXPECT_EQ(outcome.err, err);
    EXPECT_TRUE(Content(log_) == before) << "what is refused is left as it is";
  }
  void ExpectRefusal(const std::string& why) const {
    ExpectRefusal({Program("fogline"), "run", "--quiet", "--resume", log_},
                  log_ + ": error: --resume: " + why + "\n");
  }
  std::string File(const std::string& name) const { return folder_.File(name); }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
};

inline const Words kPaced{"--pace", "4"};

/// A run over the network. The test receives the steps of the run.
class SeenRun {
 public:
  SeenRun(const Words& command, const std::string& log)
      : bus_(runtime::FreshMulticastUrl()),
        run_(command + Words{"--lcm-url", bus_.url(), "--log", log}) {
    bus_.Subscribe(ChannelOf<truth_t>().name, [this](runtime::Bytes bytes) {
      step_ = std::max(
          step_,
          runtime::ReadInt64(bytes, runtime::kStepOffset));  // this works for signed messages too
    });
  }

  void WaitForStep(std::int64_t step) {
    const TimePoint end = Clock::now() + kPatience;
    while (step_ < step) {
      bus_.Wait(milliseconds(20));
      ASSERT_LT(Clock::now(), end) << run_.Err();
    }
  }
  void KillAtStep(std::int64_t step) {
    WaitForStep(step);
    run_.Signal(SIGKILL);
    run_.Wait();
  }
  const std::string& url() const { return bus_.url(); }
  Background& run() { return run_; }

 private:
  runtime::Bus bus_;
  Background run_;
  std::int64_t step_ = -1;
};

/// Tests that kill runners at random steps and continue the runs from their logs.
class ResumeAfterKillTest : public ResumeTest {
 protected:
  void ExpectKilledRunnersChangeNoResult(int kills) const {
    std::mt19937 random(2025);
    const auto whole = Undisturbed();
    for (int kill = 0; kill < kills; ++kill) {
      SCOPED_TRACE(kill);
      std::filesystem::remove(log_);
      const int step = std::uniform_int_distribution(0, kResumeSteps - 2)(random);
      SeenRun(Paper(kResumeSteps) + kPaced, log_).KillAtStep(step);
      // The world is at most 32 steps ahead of the log on disk.
      const auto result = ExpectSameEnd(whole);
      EXPECT_GE(result["resumed_steps"], step - 32);
      EXPECT_EQ(result["restarts"].size(), 0U);
    }
  }

  /// Kills `kills` runs for each of two transports. Each run is one process, so a signal to the
  /// runner ends the whole run.
  void ExpectKilledProcessesGoOnToTheSameResult(int kills) const {
    std::mt19937 random(2026);
    // The faster transport takes 0.2 s for these steps. The run is killed in the first half of this
    // time.
    constexpr int kMany = 20'000;
    // On a busy machine a run may end, or compute nearly all of its steps, before the test kills
    // it. Then the test tries again.
    constexpr int kTries = 10;
    const auto whole = Undisturbed(kMany);
    const std::uintmax_t size = std::filesystem::file_size(File("whole.lcm"));
    for (int kill = 0; kill < kills; ++kill) {
      for (const char* transport : {"memq", "direct"}) {
        SCOPED_TRACE(transport);
        const std::uintmax_t bytes =
            std::uniform_int_distribution<std::uintmax_t>(size / 100, size / 2)(random);
        bool killed = false;
        for (int tries = 0; tries < kTries && !killed; ++tries) {
          std::filesystem::remove(log_);
          killed = KillAt(bytes, Paper(kMany) + Words{"--transport", transport}) &&
                   std::filesystem::file_size(log_) < size / 4 * 3;
        }
        ASSERT_TRUE(killed) << "was (nearly) over before it was killed";
        const auto result = ExpectSameEnd(whole, {"--transport", transport});
        EXPECT_GT(result["resumed_steps"], 0);
        EXPECT_LT(result["resumed_steps"], kMany);
        EXPECT_EQ(result["transport"], transport) << "nothing was computed";
      }
    }
  }
};

}  // namespace fogline::test
