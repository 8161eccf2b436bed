// A rate limiter (token bucket) for the requests that a process answers: it allows a burst of
// answers, and then a fixed number of answers per second. So a flood of RESEND gets a limited
// number of answers, and the run goes on.
#pragma once

#include <algorithm>
#include <chrono>

#include "common/clock.h"

namespace fogline::runtime {

class RateLimiter {
 public:
  /// @param per_second answers that may be sent per second
  /// @param burst answers that may be sent in one burst
  constexpr RateLimiter(double per_second, double burst)
      : per_second_(per_second), burst_(burst), left_(burst) {}

  /// Whether one more message may be sent now.
  bool Has(TimePoint now) {
    const std::chrono::duration<double> passed = now - filled_;
    if (passed.count() > 0) {
      left_ = std::min(burst_, left_ + per_second_ * passed.count());
      filled_ = now;
    }
    return left_ >= 1;
  }

  /// Like Has(); if the result is true, the message counts as sent.
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
