// The clock on which a role judges its inputs in real time: the wall clock without the world's
// pauses. When the world's process stops, everybody falls silent a step later, and nobody but the
// world is to blame for that; and it cannot hear in its own pause either.
#pragma once

#include <algorithm>
#include <cstdint>

#include "services/runtime/clock.h"

namespace fogline {

/// Runs with the wall clock while the world ticks, stands still when a tick is overdue by more than
/// kGrace periods, and goes on with the next tick. It never goes backwards. Before the first tick
/// it stands at its beginning.
class RunClock {
 public:
  RunClock(Duration period, TimePoint began) : period_(period), heard_(began), limit_(began) {}

  /// The world has begun a step, or so it was heard, now. Steps in between are ticks that were not
  /// heard of, not pauses.
  void Tick(std::int64_t step, TimePoint now) {
    if (step <= step_) return;
    if (step_ < 0) {
      paused_ = now - heard_;
    } else {
      paused_ += std::max(Duration::zero(), now - Overdue(step - step_));
    }
    step_ = step;
    heard_ = now;
    limit_ = Overdue(1);
  }

  /// @pre `now` is not before the last tick
  TimePoint At(TimePoint now) const { return std::min(now, limit_) - paused_; }
  /// When At() is that, on the wall clock; TimePoint::max() if not before the next tick.
  TimePoint Wall(TimePoint at) const {
    return at > limit_ - paused_ ? TimePoint::max() : at + paused_;
  }

  /// The newest step that can be under way: a tick may be early by what another one was late.
  std::int64_t NewestPossible(TimePoint now) const { return step_ + (now - heard_) / period_ + 2; }

  bool started() const { return step_ >= 0; }

 private:
  /// Part of a period by which a tick may be late: well above what it varies by, well below what
  /// would make an input stale.
  static constexpr double kGrace = 0.25;

  TimePoint Overdue(std::int64_t steps) const {
    const double periods = static_cast<double>(steps) + kGrace;
    return heard_ + duration_cast<Duration>(periods * std::chrono::duration<double>(period_));
  }

  Duration period_;
  std::int64_t step_ = -1;  // newest that the world has begun
  TimePoint heard_;         // the last tick, on the wall clock
  TimePoint limit_;         // when the next one is overdue
  Duration paused_{};
};

}  // namespace fogline
