// How many requests a process answers: a burst, and then so many a second (a token bucket). Whoever
// floods it with RESEND gets no more than that, and the run goes on.
#pragma once

#include <algorithm>
#include <chrono>

#include "services/runtime/clock.h"

namespace fogline {

class AnswerBudget {
 public:
  /// @param per_second messages that may be sent in answer, @param burst how many of them at once
  constexpr AnswerBudget(double per_second, double burst)
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

  /// The same, and it is sent.
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

}  // namespace fogline
