// The retry timer of a node that lacks an input. The node first waits, because the input may still
// be on its way. Then it asks for the input again and again, at intervals that grow up to a limit.
#pragma once

#include <algorithm>
#include <optional>

#include "common/clock.h"

namespace fogline::runtime {

class RetryTimer {
 public:
  /// Notes that the next step lacks an input. @return when to ask for this input
  TimePoint Wait(TimePoint now) {
    if (!since_) {
      since_ = now;
      wait_ = std::clamp(kSteps * step_time_, kShortest, kLongest);
      ask_at_ = now + wait_;
    }
    return ask_at_;
  }

  /// Asked() notes that the node asks now. AskedInVain() then sets the time of the next request:
  /// the interval becomes a quarter longer.
  void Asked(TimePoint now) { asked_ = now; }
  void AskedInVain(TimePoint now) {
    wait_ = std::min(wait_ + wait_ / 4, kLongest);
    ask_at_ = now + wait_;
  }
  /// Notes that the node has asked for many steps in one request. Each step that comes (Arrived())
  /// delays the next request.
  void AskedForMany(TimePoint now) {
    wait_ = kShortest;
    ask_at_ = now + wait_;
  }
  void Arrived(TimePoint now) { ask_at_ = std::max(ask_at_, now + kShortest); }

  /// Notes that the step has been computed.
  void Computed(TimePoint now) {
    // If the node had to ask for an input of the step, the duration of the step does not show how
    // long a step usually takes. So it is left out of the average (Karn & Partridge 1987).
    if (computed_ != TimePoint{} && asked_ < computed_) {
      const Duration took = now - computed_;
      step_time_ += (took - step_time_) / (took < step_time_ ? kDown : kUp);
    }
    computed_ = now;
    since_.reset();
  }

  /// The time since which the next step is known to lack an input; nullopt if no input is missing.
  const std::optional<TimePoint>& since() const { return since_; }
  TimePoint asked() const { return asked_; }

 private:
  // The first interval is kSteps times the usual duration of a step, between kShortest and
  // kLongest.
  static constexpr int kSteps = 4;
  static constexpr Duration kShortest = milliseconds(2);
  static constexpr Duration kLongest = milliseconds(10);
  // A new step changes the smoothed duration of a step by a part of the difference: by 1/kDown if
  // the new step was shorter, and by 1/kUp if it was longer. Longer steps count less, because a
  // step also takes longer if another role has to ask for an input.
  static constexpr int kDown = 2;
  static constexpr int kUp = 64;

  std::optional<TimePoint> since_;
  TimePoint ask_at_{};
  TimePoint asked_{};
  Duration wait_{};
  TimePoint computed_{};
  Duration step_time_{};  // smoothed duration of a step
};

}  // namespace fogline::runtime
