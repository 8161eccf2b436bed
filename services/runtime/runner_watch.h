// What a role knows of its runner: whether it is there, how long to wait for it, and whether it has
// a place for the role.
#pragma once

#include <algorithm>
#include <string_view>

#include "fogline/run_t.hpp"
#include "services/runtime/own_pauses.h"

namespace fogline {

/// Whether a run has a place for a role that is started elsewhere.
enum class Seat {
  kNone,   ///< it starts that role itself
  kFree,   ///< it waits for it
  kOurs,   ///< this process has it
  kTaken,  ///< another process has it
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
  /// A runner says something five times a second. After ten times that it did not, a role that
  /// another run waits for goes there: a runner that is held up is not held up for so long on a
  /// machine that is fit for it, and one that a person has stopped may come too late.
  static constexpr Duration kSilent = milliseconds(2000);
  /// Without another run a role waits for longer than the runner waits for a step. By then the run
  /// is lost but for its runner's own pause (Ctrl-Z), which may take so much longer.
  static constexpr Duration kGone = milliseconds(15'000);
  /// Of a run whose runner does not say it: the default of `fogline run`.
  static constexpr Duration kStallLimit = milliseconds(4000);

  explicit RunnerWatch(TimePoint now) : pauses_(now) {}

  /// Notes that the process looks at the clock: before it is asked for how long something lasts.
  /// @return when it has looked last
  TimePoint Attend(TimePoint now) { return pauses_.Attend(now); }
  /// The runner has said something new.
  void Heard(const run_t& run, TimePoint now) {
    constexpr std::int64_t kMax_ms = 1'000'000'000;  // the largest that fogline run takes
    if (run.stall_ms > 0) stall_limit_ = milliseconds(std::min(run.stall_ms, kMax_ms));
    heard_ = now;
  }
  /// There is no runner any more.
  void Forget() { heard_ = {}; }

  /// For how long it has said nothing, the time in which this process was held up left out. Zero if
  /// there is none.
  Duration Silence(TimePoint now) const {
    return heard_ == TimePoint{} ? Duration::zero() : pauses_.HeldAgainst(heard_, now);
  }
  bool Silent(TimePoint now) const { return Silence(now) > kSilent; }
  bool Gone(TimePoint now) const { return Silence(now) > stall_limit_ + kGone; }
  /// Whether something has lasted for longer than the run waits for a step.
  bool Stalled(TimePoint since, TimePoint now) const {
    return pauses_.HeldAgainst(since, now) > stall_limit_;
  }

 private:
  OwnPauses pauses_;
  TimePoint heard_{};
  Duration stall_limit_ = kStallLimit;
};

}  // namespace fogline
