// A rate limiter (token bucket). It allows a burst of messages, and then a fixed number of messages
// per second. For example, a flood of RESEND gets a limited number of answers, and the run goes on.
#pragma once

#include <algorithm>
#include <chrono>

#include "common/clock.h"

namespace fogline::runtime {

class RateLimiter {
 public:
  /// @param per_second messages that are allowed per second
  /// @param burst messages that are allowed in one burst
  constexpr RateLimiter(double per_second, double burst)
      : per_second_(per_second), burst_(burst), left_(burst) {}

  /// Whether one more message is allowed now.
  bool Has(TimePoint now) {
    const std::chrono::duration<double> passed = now - filled_;
    if (passed.count() > 0) {
      left_ = std::min(burst_, left_ + per_second_ * passed.count());
      filled_ = now;
    }
    return left_ >= 1;
  }

  /// Like Has(); if the result is true, the message is counted.
  bool Take(TimePoint now) {
    if (!Has(now)) return false;
    left_ -= 1;
    return true;
  }

 private:
  double per_second_;
  double burst_;
  double left_;
  TimePoint filled_{};
};

}  // namespace fogline::runtime
