// Estimates the newest step that a run in real time can have reached, by the receiver's own clock.
// A message of a later step must be wrong.
//
// A message of a step proves that the world has begun this step. The world never runs faster than
// its clock, so each proof gives an upper bound for the steps at all later times. A proof that
// comes late (a TRUTH that was lost and sent again) gives a bound that is too low. So the highest
// (loosest) bound counts. This bound comes from the message with the shortest delay. If the world
// stops for a time, the bound becomes higher than necessary. If the clocks of the world and the
// receiver drift apart, newer proofs are better, so old proofs are forgotten.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "common/clock.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::runtime {

class StepHorizon {
 public:
  /// @param period duration of a step on the wall clock, above 0
  /// @param slack steps by which the world can be ahead of the bound that the best proof gives
  /// @param remembered a proof counts for this time at least, and for twice this time at most. In
  ///     every interval of this length, at least one proof must come without delay.
  StepHorizon(Duration period, std::int64_t slack, Duration remembered)
      : period_(period), slack_(slack), remembered_(remembered) {}

  /// Adds a proof that the world had begun `step` by `now`.
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
  /// The newest step that the world can have begun. @pre known()
  std::int64_t Newest(TimePoint now) const {
    return loosest_.step + (now - loosest_.time) / period_ + slack_;
  }

 private:
  struct Proof {
    std::int64_t step = 0;
    TimePoint time{};
  };

  /// Whether the newer proof's bound is at least as high as the older proof's bound.
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
  Proof recent_;  // best proof since recent_since_
  TimePoint recent_since_{};
};

/// Estimates the newest step of a run from its messages and from the runner's reports.
///
/// There are two limits. The progress that the runner reports gives the first limit, which always
/// counts. The messages of steps give the second limit, which counts only while messages of new
/// steps come. The second limit may be too low, for example if a role that was started in the
/// middle of the run first receives an old message. The role then refuses the messages of new
/// steps, but only until the second limit no longer counts. One false message can make the estimate
/// too high by two steps (kSlack). Many false messages can make it too high by one second at most,
/// because of the first limit.
class RunHorizon {
 public:
  /// @param period duration of a step on the wall clock, above 0
  explicit RunHorizon(Duration period)
      : period_(period),
        heard_(period, kSlack, kHeardPeriods * period),
        told_(period, kSlack + kHearsay / period, kToldFor) {}

  /// Notes that a message of the step has come.
  void Heard(std::int64_t step, TimePoint now) {
    heard_.Heard(step, now);
    KnowOf(step);
  }
  /// Notes that the runner has reported this progress.
  void Told(std::int64_t progress, TimePoint now) { told_.Heard(progress, now); }
  /// Notes that the world has begun this step, as the runner or a message of the step shows.
  void KnowOf(std::int64_t step) { newest_ = std::max(newest_, step); }

  /// The newest step that is known to have begun, -1 if none.
  std::int64_t newest() const { return newest_; }
  /// The newest step that the world can have begun. @pre the runner has reported its progress
  /// @param silence the time since the first message of the newest step
  std::int64_t NewestPossible(TimePoint now, Duration silence) const {
    const std::int64_t told = told_.Newest(now);
    const bool hears = heard_.known() && silence <= kUnheard * period_;
    return hears ? std::min(heard_.Newest(now), told) : told;
  }

 private:
  /// The world may be ahead of the estimate by two steps. The first of these steps is needed
  /// because the estimate may be based on a step that the world began late, by less than a period.
  /// The second step is needed because a message takes some time to arrive.
  static constexpr std::int64_t kSlack = 2;
  /// The progress that the runner reports is at most this old. In this time a role sends five
  /// STATUS messages, of which some may be lost.
  static constexpr Duration kHearsay = milliseconds(1000);
  /// The times for which a proof counts at least (`remembered` of StepHorizon): kHeardPeriods
  /// periods for a message, and kToldFor for a report of the runner. A message may come late
  /// because it was sent again. But it comes at most kRingSteps periods late, because its producer
  /// keeps only kRingSteps steps. A report may have old progress, because the runner receives no
  /// STATUS for some time. In a run that goes on, this time is shorter than a minute.
  static constexpr std::int64_t kHeardPeriods = kRingSteps;
  static constexpr Duration kToldFor = milliseconds(60'000);
  /// After this many periods without a newer step, the runner's progress alone limits the steps.
  static constexpr int kUnheard = 3;

  Duration period_;
  StepHorizon heard_;  // the limit by the messages of steps
  StepHorizon told_;   // the limit by the runner's progress
  std::int64_t newest_ = -1;
};

}  // namespace fogline::runtime
