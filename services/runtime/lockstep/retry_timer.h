// The retry timer of a node that lacks an input. It waits while the input may still be on its way.
// Then, while the input does not come, it asks again and again, at growing intervals up to a limit.
#pragma once

#include <algorithm>
#include <optional>

#include "common/clock.h"

namespace fogline::runtime {

class RetryTimer {
 public:
  /// The next step lacks an input. @return when to ask for it
  TimePoint Wait(TimePoint now) {
    if (!since_) {
      since_ = now;
      wait_ = std::clamp(kSteps * step_time_, kShortest, kLongest);
      ask_at_ = now + wait_;
    }
    return ask_at_;
  }

  /// The node asks now. After AskedInVain() it asks again, each time after an interval that is a
  /// quarter longer.
  void Asked(TimePoint now) { asked_ = now; }
  void AskedInVain(TimePoint now) {
    wait_ = std::min(wait_ + wait_ / 4, kLongest);
    ask_at_ = now + wait_;
  }
  /// The node has asked for many steps at once. As long as such steps come in, it need not ask
  /// again.
  void AskedForMany(TimePoint now) {
    wait_ = kShortest;
    ask_at_ = now + wait_;
  }
  void Arrived(TimePoint now) { ask_at_ = std::max(ask_at_, now + kShortest); }

  /// The step is computed.
  void Computed(TimePoint now) {
    // Steps with a repair do not show how long a step takes (Karn & Partridge 1987).
    if (computed_ != TimePoint{} && asked_ < computed_) {
      const Duration took = now - computed_;
      step_time_ += (took - step_time_) / (took < step_time_ ? kDown : kUp);
    }
    computed_ = now;
    since_.reset();
  }

  /// The time from which on the next step has been known to lack an input; nullopt if it lacks
  /// none.
  const std::optional<TimePoint>& since() const { return since_; }
  TimePoint asked() const { return asked_; }

 private:
  // The first interval is kSteps times the usual duration of a step, between kShortest and
  // kLongest.
  static constexpr int kSteps = 4;
  static constexpr Duration kShortest = milliseconds(2);
  static constexpr Duration kLongest = milliseconds(10);
  // Inverse weights of the newest step in the smoothed duration of a step. Repairs of other roles
  // make steps longer, too, so a shorter step has the larger weight.
  static constexpr int kDown = 2;
  static constexpr int kUp = 64;

  std::optional<TimePoint> since_;
  TimePoint ask_at_{};
  TimePoint asked_{};
  Duration wait_{};
  TimePoint computed_{};
  Duration step_time_{};  // smoothed
};

}  // namespace fogline::runtime
