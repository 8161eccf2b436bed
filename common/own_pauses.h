// The times in which this process itself could not run: it was stopped (Ctrl-Z), was frozen with
// its container, or waited for a disk. The silence of another process in such a time means nothing.
//
// The time in which the machine was suspended is no such pause, because Clock stands still during
// this time.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "common/clock.h"

namespace fogline {

class OwnPauses {
 public:
  /// A longer time between two looks at the clock is a pause. Every process looks several times a
  /// second (OwnStatus::kHeartbeat is the longest interval).
  static constexpr Duration kPause = milliseconds(500);

  explicit OwnPauses(TimePoint now) : looked_(now) {}

  /// Notes that the process looks at the clock. @return the time of its latest look
  TimePoint Attend(TimePoint now) {
    if (now <= looked_) return looked_;
    const Duration away = now - looked_;
    if (away > kPause) {
      pauses_.push_back({.from = looked_, .to = now});
      longest_ = std::max(longest_, away);
    }
    return looked_ = now;
  }

  /// The part of the time from `since` to `now` in which this process could have heard a message.
  Duration HeldAgainst(TimePoint since, TimePoint now) const {
    Duration held = now - since;
    for (auto pause = pauses_.rbegin(); pause != pauses_.rend() && pause->to > since; ++pause) {
      held -= pause->to - std::max(pause->from, since);
    }
    return held;
  }

  /// The longest pause since the last call, 0 if there was none.
  Duration TakeLongest() { return std::exchange(longest_, Duration::zero()); }

 private:
  struct Pause {
    TimePoint from;
    TimePoint to;
  };
  TimePoint looked_;           // time of the latest look
  std::vector<Pause> pauses_;  // in the order of time
  Duration longest_{};
};

}  // namespace fogline
