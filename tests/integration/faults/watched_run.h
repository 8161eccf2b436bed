// A run over the network. The test receives the messages of the run.
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"

namespace fogline::test {

// Number of steps of a watched run, and its pace. At this pace each step takes 10 ms. So the run
// takes 4 s, and a test on a busy machine can still disturb the run in its middle.
inline constexpr int kSteps = 400;
inline constexpr int kPace = 10;

inline std::vector<std::string> PaperOf(int steps, const std::vector<std::string>& more) {
  std::vector<std::string> command{Program("fogline"), "run",   "scenario/paper.json",
                                   "--json",           "--set", "/steps=" + std::to_string(steps)};
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

/// Digest of an undisturbed run of the paper's scenario with these changes.
inline std::string UndisturbedDigest(int steps, const std::vector<std::string>& changes) {
  static std::map<std::pair<int, std::vector<std::string>>, std::string> known;
  std::string& digest = known[{steps, changes}];
  if (digest.empty()) {
    std::vector<std::string> arguments{"--transport", "direct"};
    arguments.insert(arguments.end(), changes.begin(), changes.end());
    const Outcome outcome = RunCommand(PaperOf(steps, arguments));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    digest = nlohmann::json::parse(outcome.out).at("digest");
  }
  return digest;
}

/// A run over the network. Its STATUS messages tell the test which process has which role.
class WatchedRun {
 public:
  /// @param changes changes of the scenario, such as "--set", "/steps=10"
  explicit WatchedRun(const std::vector<std::string>& more = {}, int steps = kSteps,
                      int pace = kPace, const std::vector<std::string>& changes = {})
      : steps_(steps),
        changes_(changes),
        bus_(runtime::FreshMulticastUrl()),
        log_(folder_.File("run.lcm")),
        run_(Command(more, pace)) {
    bus_.Subscribe(ChannelOf<truth_t>().name, [this](runtime::Bytes bytes) {
      truth_t truth{};
      if (runtime::Decode(bytes, truth)) step_ = std::max(step_, truth.header.step);
    });
    bus_.Subscribe(ChannelOf<status_t>().name, [this](runtime::Bytes bytes) {
      status_t status{};
      if (runtime::Decode(bytes, status)) last_[status.role][status.pid] = status;
    });
  }

  /// Handles messages until the condition holds. @throws std::runtime_error after the time limit
  template <class Condition>
  void WaitUntil(const Condition& condition, const std::string& what) {
    const TimePoint end = Clock::now() + kPatience;
    while (!condition()) {
      bus_.Wait(milliseconds(20));
      if (Clock::now() > end || !IsAlive(run_.pid())) {
        throw std::runtime_error("waited in vain for " + what + "\n" + run_.Err());
      }
    }
  }
  void WaitForStep(std::int64_t step) {
    WaitUntil([&] { return step_ >= step; }, "step " + std::to_string(step));
  }

  /// Waits for a message, at most for this time, and handles all messages that have come.
  void Listen(Duration time) {
    if (bus_.Wait(time)) bus_.Drain();
  }

  /// The process that has a role at present. Processes that this test has killed do not count.
  pid_t PidOf(const std::string& role) {
    pid_t pid = 0;
    WaitUntil(
        [&] {
          for (const auto& [candidate, status] : last_[role]) {
            if (!gone_.contains(candidate)) pid = candidate;
          }
          return pid != 0;
        },
        role);
    return pid;
  }
  void Signal(const std::string& role, int signal) {
    const pid_t pid = PidOf(role);
    gone_[pid] = true;
    kill(pid, signal);
  }
  /// The state that a process has reported last; -1 if the process has reported no state.
  std::int8_t StateOf(const std::string& role, pid_t pid) {
    return last_[role].contains(pid) ? last_[role][pid].state : std::int8_t{-1};
  }
  void WaitForState(const std::string& role, std::int8_t state) {
    const pid_t pid = PidOf(role);
    WaitUntil([&] { return last_[role][pid].state == state; }, "another state of " + role);
  }

  /// Waits for the end. @return the result, which must be that of the undisturbed run
  nlohmann::json ExpectSameResult() {
    EXPECT_EQ(run_.Wait(), 0) << run_.Err();
    const auto result = nlohmann::json::parse(run_.Out(), nullptr, false);
    EXPECT_EQ(result.value("digest", ""), UndisturbedDigest(steps_, changes_)) << run_.Err();
    EXPECT_EQ(result.value("steps", 0), steps_);
    return result;
  }
  /// The number of restarts of a role, from the result.
  static int RestartsOf(const nlohmann::json& result, const std::string& role) {
    for (const auto& entry : result.at("restarts")) {
      if (entry.at("role") == role) return entry.at("count");
    }
    return 0;
  }

  Background& run() { return run_; }
  std::string RunId() const { return run_.Err().substr(4, run_.Err().find(" on ") - 4); }
  const std::string& url() const { return bus_.url(); }
  std::string File(const std::string& name) const { return folder_.File(name); }

 private:
  std::vector<std::string> Command(const std::vector<std::string>& more, int pace) const {
    std::vector<std::string> arguments{"--lcm-url", bus_.url(), "--log",
                                       log_,        "--pace",   std::to_string(pace)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    // The default of --stall-timeout is 4 s. On a busy machine new processes may need more than 4 s
    // to start, so the test gives them 30 s.
    if (std::ranges::find(more, "--stall-timeout") == more.end()) {
      arguments.insert(arguments.end(), {"--stall-timeout", "30"});
    }
    arguments.insert(arguments.end(), changes_.begin(), changes_.end());
    return PaperOf(steps_, arguments);
  }

  const int steps_;
  const std::vector<std::string> changes_;
  ScratchFolder folder_;
  runtime::Bus bus_;
  std::string log_;
  Background run_;
  std::int64_t step_ = -1;
  std::map<std::string, std::map<pid_t, status_t>> last_;
  std::map<pid_t, bool> gone_;
};

}  // namespace fogline::test
