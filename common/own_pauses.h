// The times in which this process itself could not run: it was stopped (Ctrl-Z), was frozen with
// its container, or waited for a disk. In such a time this process receives no messages of another
// process, although the other process may be healthy.
//
// A suspend of the machine does not count, because Clock does not advance during the suspend.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "common/clock.h"

namespace fogline {

class OwnPauses {
 public:
  /// If the time between two calls of Attend() is longer than kPause, it counts as a pause. Every
  /// process calls Attend() several times a second (OwnStatus::kHeartbeat is the longest interval).
  static constexpr Duration kPause = milliseconds(500);

  explicit OwnPauses(TimePoint now) : looked_(now) {}

  /// Records that the process runs at the time `now`. @return the latest recorded time
  TimePoint Attend(TimePoint now) {
    if (now <= looked_) return looked_;
    const Duration away = now - looked_;
    if (away > kPause) {
      pauses_.push_back({.from = looked_, .to = now});
      longest_ = std::max(longest_, away);
    }
    return looked_ = now;
  }

  /// The time from `since` to `now`, minus the pauses of this process. Only this time counts as
  /// silence of another process.
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
  TimePoint looked_;           // the latest recorded time
  std::vector<Pause> pauses_;  // in the order of time
  Duration longest_{};
};

}  // namespace fogline
