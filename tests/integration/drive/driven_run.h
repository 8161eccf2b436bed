// Helpers for tests of runs in real time that a person drives.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/integration/realtime/realtime_run.h"

namespace fogline::test {

inline constexpr const char* kDriveScenario = "scenario/drive.json";

/// On a busy machine a message of a role may be late. Tests about persons are not about late roles,
/// so an input counts as LOST only after 100 periods.
inline constexpr const char* kLateRolesAreNotLost = "/health/lost_periods=100";

/// On a busy machine a seat may send an input late. So the person counts as absent only after 5 s
/// without an input. Only the tests of this limit itself use the usual limit, 0.3 s.
inline constexpr const char* kALatePersonIsThere = "/person/deadman_s=5";

/// Settings with which the policy always wants the human. So the person is asked to take over from
/// the first step on.
inline std::vector<std::string> AlwaysAsked() {
  return {"/person/drives=true", "/arbitrator/threshold=0", "/arbitrator/take_over/mode=requested",
          kLateRolesAreNotLost};
}

/// AlwaysAsked() for a person at a page. On a busy machine fogline-web may count this person as
/// absent for a moment. With `until_back` the person only has to answer again, and then drives on.
inline std::vector<std::string> AlwaysAskedAtAPage() {
  std::vector<std::string> changes = AlwaysAsked();
  changes.emplace_back("/person/when_gone=until_back");
  return changes;
}

/// The newest DRIVER_COMMAND and the newest HOST_COMMAND on a network.
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

  /// Waits until holds() is true. @return the time of the wait, in s; a negative number if the
  /// limit has passed
  double WaitFor(const std::function<bool()>& holds, Duration limit = kPatience) {
    const TimePoint begin = Clock::now();
    while (!holds()) {
      // If messages still wait, the time limit does not end this loop. The machine may have delayed
      // the test itself, and one of these messages may make holds() true.
      const bool more = bus_.Wait(milliseconds(5));
      if (!more && Clock::now() - begin > limit) return -1;
    }
    return Seconds(Clock::now() - begin);
  }

  driver_command_t driver{};
  arbitration_t host{};

 private:
  runtime::Bus bus_;
};

/// Returns the command that starts a seat as a process of its own (scripted_seat.cc).
inline std::vector<std::string> SeatCommand(const std::string& url, const std::string& script) {
  return {Program("scripted_seat"), url, script};
}

}  // namespace fogline::test
