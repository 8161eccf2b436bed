// Limits the number of frames that a client may send.
#pragma once

#include <algorithm>

#include "common/clock.h"

namespace fogline::web {

/// A token bucket: it is full at the beginning, each frame takes one token, and it fills up again
/// at a constant rate. So a client may send `frames` frames together, and then `frames` a second.
class FrameBudget {
 public:
  static constexpr double kFrames = 200;
  /// Limit for a client that drives. The seat itself refuses more than 250 inputs a second, and
  /// answers each refused input. A client that sends twice as many inputs ignores these answers,
  /// and is cut off.
  static constexpr double kSeatFrames = 500;

  explicit FrameBudget(TimePoint now, double frames = kFrames)
      : frames_(frames), left_(frames), at_(now) {}

  double frames() const { return frames_; }

  /// Counts a frame. @return false if there are too many
  [[nodiscard]] bool Take(TimePoint now) {
    left_ = std::min(frames_, left_ + frames_ * Seconds(now - at_));
    at_ = now;
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
  }

 private:
  double frames_;
  double left_;
  TimePoint at_;
};

}  // namespace fogline::web
