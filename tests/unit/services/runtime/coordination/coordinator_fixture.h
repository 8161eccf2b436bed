// A run coordinator. The test publishes the messages of all roles for this coordinator.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/process/this_process.h"
#include "services/runtime/coordination/run_coordinator.h"
#include "services/runtime/wire/digest.h"
#include "tests/unit/services/runtime/script.h"

namespace fogline::test {

class RunCoordinatorTest : public testing::Test {
 protected:
  RunCoordinatorTest() {
    for (const RoleInfo& info : kRoles) {
      status_t& status = roles_[static_cast<std::size_t>(info.role)];
      status = Script::Of<status_t>(-1);
      status.role = info.name;
      status.host = HostName();
      status.pid = 100 + static_cast<std::int32_t>(info.role);
      status.instance = status.pid;
      status.state = status_t::READY;
      status.scenario_hash = runtime::HashOf(script_.text());
      status.type_fingerprint = TypeFingerprint();
    }
  }

  /// The options of a run in real time whose steps have this period.
  runtime::RunCoordinatorOptions InRealtime(std::int64_t steps, Duration period) const {
    return {.run_id = Script::kRunId,
            .scenario_text = script_.text(),
            .steps = steps,
            .pace = 1,
            .realtime = true,
            .period = period};
  }
  status_t& role(Role role) { return roles_[static_cast<std::size_t>(role)]; }
  void SayStatus(Role who) {
    ++role(who).sequence;
    script_.Say(role(who));
  }
  /// Publishes a STATUS of every role, so that the run is at this step.
  void BeAtStep(std::int64_t step) {
    for (const RoleInfo& info : kRoles) {
      role(info.role).header.step = step;
      role(info.role).state = step < 0 ? status_t::READY : status_t::RUNNING;
      SayStatus(info.role);
    }
    Poll(Clock::now());
  }
  void Poll(TimePoint now) {
    coordinator_.Poll(now);
    script_.bus().Drain();
  }
  /// Calls Poll() every 20 ms until `end`, as a runner does.
  static void PollUntil(runtime::RunCoordinator& coordinator, TimePoint end) {
    for (TimePoint now = Clock::now(); now < end; now += milliseconds(20)) coordinator.Poll(now);
    coordinator.Poll(end);
  }
  /// Replaces the process of a role by another process.
  void Replace(Role who) {
    role(who).pid += 1000;
    role(who).instance += 1000;
    role(who).sequence = 0;
    role(who).header.step = -1;
    role(who).state = status_t::READY;
  }

  Script script_;
  std::vector<run_t>& said_ = script_.Listen<run_t>();
  runtime::RunCoordinator coordinator_{script_.bus(),
                                       {.run_id = Script::kRunId, .scenario_text = script_.text()}};
  std::array<status_t, kRoles.size()> roles_{};
};

}  // namespace fogline::test
