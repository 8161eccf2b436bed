// How far a run in real time can be, by the reader's own clock: what is of a later step is from the
// future, and whoever claims it is wrong.
//
// The world never runs faster than its clock, so each proof that it had begun a step by some time
// bounds all later times. A proof that comes late (a TRUTH that was lost and sent again) bounds too
// low, so the loosest one counts: that of the message that was on its way for the shortest time. A
// world that stands still makes it only looser, and of two clocks that drift apart the newer
// proofs know better, so old ones are forgotten.
#pragma once

#include <cstdint>
#include <utility>

#include "services/runtime/clock.h"

namespace fogline {

class StepHorizon {
 public:
  /// @param period of the steps on the wall clock, above 0
  /// @param slack steps by which the world can be further than the best proof says
  /// @param remembered time for which a proof counts at least; twice as long at most. Proofs must
  ///     not all come late for so long.
  StepHorizon(Duration period, std::int64_t slack, Duration remembered)
      : period_(period), slack_(slack), remembered_(remembered) {}

  /// The world had begun this step by then.
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

  /// Whether the newer of two proofs allows as much as the older one.
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

}  // namespace fogline
