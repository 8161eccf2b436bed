// A run in real time with a person, and the commands in it.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/integration/realtime/realtime_run.h"

namespace fogline::test {

inline constexpr const char* kDriveScenario = "scenario/drive.json";

/// In this run the policy always wants the human, so the person is asked from the first step on.
inline std::vector<std::string> AlwaysAsked() {
  return {"/person/drives=true", "/arbitrator/threshold=0", "/arbitrator/take_over/mode=requested"};
}

/// The newest command of the driver, and that of the host, on a network.
class Commands {
 public:
  explicit Commands(const std::string& url) : bus_(url) {
    bus_.Subscribe(ChannelOf<driver_command_t>().name, [this](runtime::Arrival& arrival) {
      if (const auto* command = arrival.As<driver_command_t>()) driver = *command;
    });
    bus_.Subscribe(ChannelOf<arbitration_t>().name, [this](runtime::Arrival& arrival) {
      if (const auto* command = arrival.As<arbitration_t>()) host = *command;
    });
  }

  /// Waits for a condition. @return the time until it holds; a negative time after the limit
  double WaitFor(const std::function<bool()>& holds, Duration limit = kPatience) {
    const TimePoint begin = Clock::now();
    while (!holds()) {
      if (Clock::now() - begin > limit) return -1;
      bus_.Wait(milliseconds(5));
    }
    return Seconds(Clock::now() - begin);
  }

  driver_command_t driver{};
  arbitration_t host{};

 private:
  runtime::Bus bus_;
};

/// A seat in a process of its own (scripted_seat.cc).
inline std::vector<std::string> SeatCommand(const std::string& url, const std::string& script) {
  return {Program("scripted_seat"), url, script};
}

}  // namespace fogline::test
