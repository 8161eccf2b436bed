// How many frames a client may send.
#pragma once

#include <algorithm>

#include "common/clock.h"

namespace fogline::web {

/// A token bucket: it is full at the beginning, each frame takes one token, and it fills up again
/// at a constant rate. So a client may send `kFrames` frames at once, and then as many a second.
class FrameBudget {
 public:
  static constexpr double kFrames = 200;

  explicit FrameBudget(TimePoint now) : at_(now) {}

  /// Counts a frame. @return false if there are too many
  [[nodiscard]] bool Take(TimePoint now) {
    left_ = std::min(kFrames, left_ + kFrames * Seconds(now - at_));
    at_ = now;
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
  }

 private:
  double left_ = kFrames;
  TimePoint at_;
};

}  // namespace fogline::web
