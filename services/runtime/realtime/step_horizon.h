// The newest step that a run in real time can have reached, by the reader's own clock. A message of
// a later step must be wrong.
//
// The world never runs faster than its clock. So each message that proves that the world had begun
// a step by some time gives an upper bound for all later times. A proof that comes late (a TRUTH
// that was lost and sent again) gives a bound that is too low, so the loosest bound counts: that of
// the message that was on its way for the shortest time. If the world stands still, the bound only
// becomes looser. If two clocks drift apart, newer proofs are better, so old ones are forgotten.
#pragma once

#include <cstdint>
#include <utility>

#include "common/clock.h"

namespace fogline::runtime {

class StepHorizon {
 public:
  /// @param period of the steps on the wall clock, above 0
  /// @param slack steps by which the world can be further than the best proof says
  /// @param remembered least time for which a proof counts; the longest is twice that. At least one
  ///     of the proofs of such a time must come without delay.
  StepHorizon(Duration period, std::int64_t slack, Duration remembered)
      : period_(period), slack_(slack), remembered_(remembered) {}

  /// Takes note of a proof that the world had begun `step` by `now`.
  void Heard(std::int64_t step, TimePoint now) {
    const Proof proof{.step = step, .time = now};
    if (known_ && now - recent_since_ >= remembered_) {
      loosest_ = std::exchange(recent_, proof);
      recent_since_ = now;
    }
    if (!known_) recent_since_ = now;
    if (!known_ || Allows(proof, loosest_)) loosest_ = proof;
    if (!known_ || Allows(proof, recent_)) recent_ = proof;
    known_ = true;
  }

  bool known() const { return known_; }
  /// The newest step that can be under way. @pre known()
  std::int64_t Newest(TimePoint now) const {
    return loosest_.step + (now - loosest_.time) / period_ + slack_;
  }

 private:
  struct Proof {
    std::int64_t step = 0;
    TimePoint time{};
  };

  /// Whether the newer of two proofs gives a bound that is at least as loose as that of the older.
  bool Allows(const Proof& newer, const Proof& older) const {
    const double periods = static_cast<double>((newer.time - older.time).count()) /
                           static_cast<double>(period_.count());
    return static_cast<double>(newer.step - older.step) >= periods;
  }

  Duration period_;
  std::int64_t slack_;
  Duration remembered_;
  bool known_ = false;
  Proof loosest_;
  Proof recent_;  // loosest of the last ones
  TimePoint recent_since_{};
};

}  // namespace fogline::runtime
