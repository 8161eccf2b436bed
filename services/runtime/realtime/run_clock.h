// The clock by which a role judges its inputs in real time: the wall clock without the world's
// pauses. If the world's process pauses, all other roles stop publishing after one more step,
// although only the world is to blame. By this clock, their messages do not become old during the
// pause. The world itself receives no inputs during its pause. By this clock, its inputs do not
// become old either.
#pragma once

#include <algorithm>
#include <cstdint>

#include "common/clock.h"

namespace fogline::runtime {

/// The clock runs with the wall clock while the run goes on. It stops when the next step is overdue
/// by more than kGrace periods, and continues when a message of the next step comes. If steps were
/// skipped in between, the clock advances by the periods of these steps, too. A message may also
/// come late without a pause of the world (a TRUTH that was lost and sent again). Then the clock
/// also stops. The next message that comes in time corrects the clock. The clock never goes
/// backwards, and is never ahead of the wall clock. Before the first step, the clock stands at
/// `began`.
class RunClock {
 public:
  RunClock(Duration period, TimePoint began)
      : period_(period), heard_(began), then_(began), due_(began), limit_(began) {}

  /// Notes that a message of this step has come. The message shows that the world has begun the
  /// step.
  void Heard(std::int64_t step, TimePoint now) {
    if (step <= step_) return;
    then_ = At(now);
    if (step_ >= 0) due_ = std::min(now, due_ + Periods(static_cast<double>(step - step_)));
    then_ = std::max(then_, due_);
    limit_ = std::max(then_, due_ + Periods(1 + kGrace));
    step_ = step;
    heard_ = now;
  }

  /// This clock's time at the wall-clock time `now`. @pre `now` is not before the last call of
  /// Heard()
  TimePoint At(TimePoint now) const { return std::min(then_ + (now - heard_), limit_); }
  /// The wall-clock time at which At() reaches `at`; TimePoint::max() if At() does not reach `at`
  /// before the next step.
  TimePoint Wall(TimePoint at) const {
    return at > limit_ ? TimePoint::max() : heard_ + (at - then_);
  }

  bool started() const { return step_ >= 0; }
  /// The time since the first message of the newest step.
  Duration Silence(TimePoint now) const { return now - heard_; }

 private:
  /// The share of a period by which a tick may be late. It is well above the usual variation of
  /// ticks, and well below the delay that makes an input stale.
  static constexpr double kGrace = 0.25;
  /// A time that is longer than any run. The sum of two such times does not overflow.
  static constexpr double kLongest_ns = 1e18;

  Duration Periods(double periods) const {
    return Duration(static_cast<Duration::rep>(
        std::min(periods * static_cast<double>(period_.count()), kLongest_ns)));
  }

  Duration period_;
  std::int64_t step_ = -1;  // newest step of which a message has come
  TimePoint heard_;         // when the first message of step_ came, on the wall clock
  TimePoint then_;          // heard_ on this clock
  TimePoint due_;           // when step_ was due, on this clock
  TimePoint limit_;         // the time at which this clock stops
};

}  // namespace fogline::runtime
