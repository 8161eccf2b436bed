// When a node that lacks an input asks for it: not while it may still be on its way, and again and
// again, at longer and longer intervals up to a limit, while it does not come.
#pragma once

#include <algorithm>
#include <optional>

#include "services/runtime/clock.h"

namespace fogline {

class Patience {
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

  /// Asked now; who waits on asks again, each time after a quarter more.
  void Asked(TimePoint now) { asked_ = now; }
  void AskedInVain(TimePoint now) {
    wait_ = std::min(wait_ + wait_ / 4, kLongest);
    ask_at_ = now + wait_;
  }
  /// Asked for many steps at once: as long as they come in there is no reason to ask again.
  void AskedForMany(TimePoint now) {
    wait_ = kShortest;
    ask_at_ = now + wait_;
  }
  void Arrived(TimePoint now) { ask_at_ = std::max(ask_at_, now + kShortest); }

  /// The step is computed.
  void Computed(TimePoint now) {
    // Steps that had to be repaired say nothing of how long a step takes (Karn & Partridge 1987).
    if (computed_ != TimePoint{} && asked_ < computed_) {
      const Duration took = now - computed_;
      step_time_ += (took - step_time_) / (took < step_time_ ? kDown : kUp);
    }
    computed_ = now;
    since_.reset();
  }

  /// Since when the next step is known to lack an input.
  const std::optional<TimePoint>& since() const { return since_; }
  TimePoint asked() const { return asked_; }

 private:
  // A few times what a step usually takes, within bounds; a little longer each time that it asks in
  // vain.
  static constexpr int kSteps = 4;
  static constexpr Duration kShortest = milliseconds(2);
  static constexpr Duration kLongest = milliseconds(10);
  // Inverse weights of the newest step in the smoothed duration of a step. Others' repairs make
  // steps longer, too: the short ones tell what a step takes.
  static constexpr int kDown = 2;
  static constexpr int kUp = 64;

  std::optional<TimePoint> since_;
  TimePoint ask_at_{};
  TimePoint asked_{};
  Duration wait_{};
  TimePoint computed_{};
  Duration step_time_{};  // smoothed
};

}  // namespace fogline
