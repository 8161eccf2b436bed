// The runner's side of a run: announces the scenario, waits until every role is ready, lets the
// world start, follows everybody's STATUS, and names the culprit when a step does not complete.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/graph.h"
#include "services/runtime/bus.h"
#include "services/runtime/clock.h"
#include "services/runtime/refusals.h"
#include "services/runtime/scenario_parts.h"
#include "services/runtime/strangers.h"

namespace fogline {

struct ConductorOptions {
  std::int64_t run_id = 0;
  std::string scenario_text;                  // the effective scenario
  double pace = 0;                            // simulated seconds per second; 0: as fast as it goes
  Duration join_limit{};                      // for the roles to be ready; 0: no limit
  Duration stall_limit = milliseconds(4000);  // without a completed step
};

class Conductor {
 public:
  enum class Phase { kJoining, kRunning, kDone, kFailed };

  Conductor(Bus& bus, ConductorOptions options);

  /// Does what is due. Call it after every Bus::Wait(). @return when to be called again at the
  /// latest
  TimePoint Poll(TimePoint now);

  Phase phase() const { return phase_; }
  /// What went wrong, one line. Empty unless phase() is kFailed.
  const std::string& error() const { return error_; }
  /// Last step that the world has begun, -1 before the first.
  std::int64_t step() const;
  /// Names of the roles that have not reported ready.
  std::string NotReady() const;
  /// Sum over the roles of a counter of status_t.
  std::int64_t Total(std::int64_t status_t::*counter) const;
  /// Messages that the roles have refused.
  Refusals Refused() const;
  /// Who is of another run and speaks on this network.
  const Strangers& strangers() const { return strangers_; }
  /// Tells every role to leave; may be repeated.
  void Stop();
  /// Ends the run with an error from outside, such as the death of a process.
  void Fail(std::string error);

  /// A role's process as its STATUS tells it.
  struct Member {
    std::optional<status_t> status;
    TimePoint heard{};
  };
  const Member& member(Role role) const { return members_[static_cast<std::size_t>(role)]; }

 private:
  void OnStatus(const status_t& status);
  void OnResend(Bytes bytes);
  bool AllReady() const;
  void Announce(std::int8_t phase, std::size_t part);
  /// The one line that says who holds up the run.
  std::string Culprit(TimePoint now) const;

  Bus& bus_;
  ConductorOptions options_;
  std::vector<std::string> parts_;
  std::string hash_;
  std::array<Member, kRoles.size()> members_;
  Strangers strangers_;
  Phase phase_ = Phase::kJoining;
  std::string error_;
  TimePoint began_;
  TimePoint announce_at_{};
  TimePoint parts_at_{};
  std::int64_t progress_ = -1;
  TimePoint progressed_{};
  std::vector<std::uint8_t> buffer_;
};

}  // namespace fogline
