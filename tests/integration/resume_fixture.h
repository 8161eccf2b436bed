// Runs that continue from their logs (`fogline run --resume`), in tests.
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "services/log/event_log.h"
#include "services/runtime/wire/message_signer.h"
#include "tests/support/command.h"

namespace fogline::test {

using Words = std::vector<std::string>;

inline Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// Steps of a run. Runs over the network take 3 ms for each, so that a test on a busy machine can
// still kill one in the middle.
inline constexpr int kResumeSteps = 300;

class ResumeTest : public testing::Test {
 protected:
  static Words Paper(int steps) {
    return {Program("fogline"), "run",   "scenario/paper.json",
            "--json",           "--set", "/steps=" + std::to_string(steps)};
  }
  /// The result of an undisturbed run. Its log is whole.lcm.
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
    // The resumed log has the same events as the whole one, and no others. Only their run ids
    // differ. With a key, the last event has a signature.
    const bool is_signed = std::ranges::find(more, "--key") != more.end();
    EXPECT_EQ(std::filesystem::file_size(log_), std::filesystem::file_size(File("whole.lcm")) +
                                                    (is_signed ? runtime::kSignatureBytes : 0));
    return result;
  }
  /// Kills the runner, not its roles, as soon as the log has `bytes` bytes.
  /// @return whether it had not ended by itself
  bool KillAt(std::uintmax_t bytes, const Words& command) const {
    Background run(command + Words{"--log", log_});
    EXPECT_TRUE(GrowsTo(bytes, log_)) << run.Err();
    run.Signal(SIGKILL);
    return run.Wait() == 128 + SIGKILL;
  }
  /// Expects that the run is refused with this text and leaves the log as it is.
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

/// Copies a log event by event. `change` may alter an event, add other events, and end the copy by
/// returning false.
template <class Change>
void Copy(const std::string& from, const std::string& to, const Change& change) {
  log::EventLogReader reader(from);
  log::EventLogWriter writer(to);
  while (const auto event = reader.Next()) {
    std::vector<std::uint8_t> data(event->data.begin(), event->data.end());
    if (!change(writer, *event, data)) return;
    writer.Write(event->channel, event->utime, data);
  }
}

}  // namespace fogline::test
