// The clock on which a role judges its inputs in real time: the wall clock without the world's
// pauses. When the world's process stops, everybody falls silent a step later, and nobody but the
// world is to blame for that; and it cannot hear in its own pause either.
#pragma once

#include <algorithm>
#include <cstdint>

#include "services/runtime/clock.h"

namespace fogline {

/// Runs with the wall clock while the run goes on, stands still when its next step is overdue by
/// more than kGrace periods, and goes on with the next one that is heard of. Steps in between were
/// not heard of: they took their time, and the clock makes up for it. A message that comes late (a
/// TRUTH that was lost and sent again) tells of a step, not of a pause: the next one that is in
/// time sets the clock right. It never goes backwards, nor ahead of the wall clock. Before the
/// first step it stands at its beginning.
class RunClock {
 public:
  RunClock(Duration period, TimePoint began)
      : period_(period), heard_(began), then_(began), due_(began), limit_(began) {}

  /// Something of a step, or so it claims, was heard now: the world has begun it.
  void Heard(std::int64_t step, TimePoint now) {
    if (step <= step_) return;
    then_ = At(now);
    if (step_ >= 0) due_ = std::min(now, due_ + Periods(static_cast<double>(step - step_)));
    then_ = std::max(then_, due_);
    limit_ = std::max(then_, due_ + Periods(1 + kGrace));
    step_ = step;
    heard_ = now;
  }

  /// @pre `now` is not before the last step
  TimePoint At(TimePoint now) const { return std::min(then_ + (now - heard_), limit_); }
  /// When At() is that, on the wall clock; TimePoint::max() if not before the next step.
  TimePoint Wall(TimePoint at) const {
    return at > limit_ ? TimePoint::max() : heard_ + (at - then_);
  }

  bool started() const { return step_ >= 0; }
  /// Time since a step was heard of that was newer than all before.
  Duration Silence(TimePoint now) const { return now - heard_; }

 private:
  /// Part of a period by which a tick may be late: well above what it varies by, well below what
  /// would make an input stale.
  static constexpr double kGrace = 0.25;
  /// Longer than any run, and no sum of two overflows.
  static constexpr double kLongest_ns = 1e18;

  Duration Periods(double periods) const {
    return Duration(static_cast<Duration::rep>(
        std::min(periods * static_cast<double>(period_.count()), kLongest_ns)));
  }

  Duration period_;
  std::int64_t step_ = -1;  // newest that was heard of
  TimePoint heard_;         // when, on the wall clock
  TimePoint then_;          // and on this one
  TimePoint due_;           // when the step was due on this one
  TimePoint limit_;         // where it stands still
};

}  // namespace fogline
