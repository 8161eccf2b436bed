// A role's information about its runner: whether the runner is alive, how long to wait for the
// runner, and whether the runner's run has a place for the role.
#pragma once

#include <algorithm>
#include <string_view>

#include "common/own_pauses.h"
#include "fogline/run_t.hpp"

namespace fogline::runtime {

/// Whether a run has a place for a role that is started elsewhere.
enum class Seat {
  kNone,   ///< the runner starts that role itself
  kFree,   ///< the run waits for the role
  kOurs,   ///< this process has the place
  kTaken,  ///< another process has the place
};

inline Seat SeatIn(const run_t& run, std::string_view role, std::int64_t instance) {
  const auto found = std::ranges::find(run.external, role);
  if (found == run.external.end()) return Seat::kNone;
  const std::int64_t holder = run.holder[static_cast<std::size_t>(found - run.external.begin())];
  if (holder == 0) return Seat::kFree;
  return holder == instance ? Seat::kOurs : Seat::kTaken;
}

class RunnerWatch {
 public:
  /// A runner sends RUN five times a second. If no RUN comes for this time (ten missing messages),
  /// a role joins another run that waits for the role. A living runner is silent for so long only
  /// if its machine is overloaded, or if a person stops it (Ctrl-Z). In these cases the role may
  /// join another run before the runner continues.
  static constexpr Duration kSilent = milliseconds(2000);
  /// If no other run waits for the role, the role leaves its run when the runner has been silent
  /// for the stall limit plus this time. After the stall limit the run has ended, except if the
  /// runner itself is paused (Ctrl-Z). The additional time is meant for a pause of the runner.
  static constexpr Duration kGone = milliseconds(15'000);
  /// The stall limit if RUN contains no stall limit: the default of `fogline run`.
  static constexpr Duration kStallLimit = milliseconds(4000);

  explicit RunnerWatch(TimePoint now) : pauses_(now) {}

  /// Notes that this process runs at the time `now`, so that its own pauses do not count as silence
  /// of the runner (OwnPauses). Call this function before Silence(), Silent(), Gone() and
  /// Stalled().
  /// @return the latest noted time
  TimePoint Attend(TimePoint now) { return pauses_.Attend(now); }
  /// Notes that the runner has sent a new RUN.
  void Heard(const run_t& run, TimePoint now) {
    constexpr std::int64_t kMax_ms = 1'000'000'000;  // the largest limit of `fogline run`
    if (run.stall_ms > 0) stall_limit_ = milliseconds(std::min(run.stall_ms, kMax_ms));
    heard_ = now;
  }
  /// Notes that the role has no runner.
  void Forget() { heard_ = {}; }

  /// The time since the last RUN, without the pauses of this process; zero if the role has no
  /// runner.
  Duration Silence(TimePoint now) const {
    return heard_ == TimePoint{} ? Duration::zero() : pauses_.HeldAgainst(heard_, now);
  }
  bool Silent(TimePoint now) const { return Silence(now) > kSilent; }
  bool Gone(TimePoint now) const { return Silence(now) > stall_limit_ + kGone; }
  /// Like Gone(), but for a sender whose last message came at the time `heard`.
  bool GoneSince(TimePoint heard, TimePoint now) const {
    return pauses_.HeldAgainst(heard, now) > stall_limit_ + kGone;
  }
  /// Whether a state that began at `since` has lasted for longer than the stall limit.
  bool Stalled(TimePoint since, TimePoint now) const {
    return pauses_.HeldAgainst(since, now) > stall_limit_;
  }

 private:
  OwnPauses pauses_;
  TimePoint heard_{};
  Duration stall_limit_ = kStallLimit;
};

}  // namespace fogline::runtime
