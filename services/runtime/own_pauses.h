// When this process was held up itself: stopped (Ctrl-Z), frozen with its container, kept by a
// disk. What it has not heard in that time means nothing.
//
// Of a machine that was suspended nothing need be known: Clock stands still meanwhile.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "services/runtime/clock.h"

namespace fogline {

class OwnPauses {
 public:
  /// Two looks at the clock that are further apart are a pause. Every process looks several times a
  /// second (Node::kHeartbeat is the longest).
  static constexpr Duration kPause = milliseconds(500);

  explicit OwnPauses(TimePoint now) : looked_(now) {}

  /// Notes that the process looks at the clock. @return when it has looked last
  TimePoint Attend(TimePoint now) {
    if (now <= looked_) return looked_;
    const Duration away = now - looked_;
    if (away > kPause) {
      pauses_.push_back({.from = looked_, .to = now});
      longest_ = std::max(longest_, away);
    }
    return looked_ = now;
  }

  /// Time since then in which something could have been heard.
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
  TimePoint looked_;           // last
  std::vector<Pause> pauses_;  // in order
  Duration longest_{};
};

}  // namespace fogline
