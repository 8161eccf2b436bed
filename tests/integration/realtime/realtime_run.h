// A run in real time whose processes a test can kill or stop.
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"

namespace fogline::test {

// Simulated seconds per second of real time.
inline constexpr double kSpeed = 5;

/// A run in real time. The test can send signals to its processes.
class RealtimeRun {
 public:
  RealtimeRun(const std::string& scenario, int steps, double speed = kSpeed,
              const std::vector<std::string>& settings = {})
      : bus_(runtime::FreshMulticastUrl()),
        log_(folder_.File("run.lcm")),
        run_(Command(scenario, steps, speed, settings)) {
    bus_.Subscribe(ChannelOf<truth_t>().name, [this](runtime::Arrival& arrival) {
      const auto* truth = arrival.As<truth_t>();
      if (truth == nullptr || truth->header.step <= step_) return;
      step_ = truth->header.step;
    });
    bus_.Subscribe(ChannelOf<status_t>().name, [this](runtime::Arrival& arrival) {
      if (const auto* status = arrival.As<status_t>()) Heard(*status);
    });
  }

  void WaitForStep(std::int64_t step) {
    const TimePoint end = Clock::now() + kPatience;
    while (step_ < step) {
      const bool heard = bus_.Wait(milliseconds(20));
      if (Clock::now() > end || (!heard && !IsAlive(run_.pid()))) {
        throw std::runtime_error("waited in vain for a step\n" + run_.Err());
      }
    }
  }
  /// Sends a signal to the process of a role. @return the step of the run at this time
  std::int64_t Signal(const std::string& role, int signal) {
    kill(pids_.at(role), signal);
    return step_;
  }
  /// The number of threads of a role's process.
  std::ptrdiff_t Threads(const std::string& role) const {
    const std::string folder = "/proc/" + std::to_string(pids_.at(role)) + "/task";
    return std::distance(std::filesystem::directory_iterator(folder), {});
  }
  /// Waits up to 5 s for the first STATUS that reports the world as lost. @return the age of the
  /// world's last message, as this STATUS reports it. This age does not include pauses of the
  /// sender of the STATUS. The result is nullopt if the world comes back before such a STATUS, or
  /// if no such STATUS comes
  std::optional<Duration> WaitForTheWorldToBeMissed() {
    const std::int64_t silent_since = step_;
    const TimePoint end = Clock::now() + std::chrono::seconds(5);
    while (!missed_after_ && step_ <= silent_since + 1 && Clock::now() < end) {
      bus_.Wait(milliseconds(5));
    }
    return missed_after_;
  }

  /// Waits for the end. @return the result
  nlohmann::json Finish() {
    EXPECT_EQ(run_.Wait(), 0) << run_.Err();
    return nlohmann::json::parse(run_.Out(), nullptr, false);
  }
  const std::string& log() const { return log_; }
  const std::string& url() const { return bus_.url(); }
  Background& run() { return run_; }

 private:
  std::vector<std::string> Command(const std::string& scenario, int steps, double speed,
                                   const std::vector<std::string>& settings) const {
    std::vector<std::string> command{Program("fogline"),
                                     "run",
                                     scenario,
                                     "--json",
                                     "--realtime",
                                     "--speed",
                                     std::to_string(speed),
                                     "--set",
                                     "/steps=" + std::to_string(steps),
                                     "--lcm-url",
                                     bus_.url(),
                                     "--log",
                                     log_};
    for (const std::string& setting : settings) {
      command.insert(command.end(), {"--set", setting});
    }
    return command;
  }
  void Heard(const status_t& status) {
    pids_[status.role] = status.pid;
    if (missed_after_ || status.role == NameOf(Role::kRecorder)) return;
    for (std::size_t i = 0; i < status.input.size(); ++i) {
      const bool world = status.input[i] == ChannelOf<truth_t>().name ||
                         status.input[i] == ChannelOf<ego_t>().name;
      if (world && status.input_state[i] == status_t::INPUT_LOST) {
        missed_after_ = std::chrono::microseconds(status.input_age_us[i]);
      }
    }
  }

  ScratchFolder folder_;
  runtime::Bus bus_;
  std::string log_;
  Background run_;
  std::int64_t step_ = -1;
  std::optional<Duration> missed_after_;
  std::map<std::string, pid_t> pids_;
};

}  // namespace fogline::test
