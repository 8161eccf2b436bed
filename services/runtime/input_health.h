// The health of one input in real time, from when its steps arrive on the receiver's own clock.
// Time is passed in: nothing here reads a clock, and senders' clocks do not matter.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "scenario/realtime.h"
#include "services/runtime/clock.h"
#include "services/runtime/input_state.h"

namespace fogline {

/// Age, rate and state of an input that brings a step in every period.
///
///     AWAITED --a step--> OK --age > stale--> STALE --age > lost--> LOST
///        |                 ^                    |                    |
///        +--age > lost--> LOST                  +-- recover_steps ---+--> OK
///
/// The age is the time since the last new step arrived, or since the beginning. The limits are
/// closed: an age of exactly `stale` is OK. Back to OK it takes `recover_steps` new steps, each but
/// the first within `stale` of the one before, which also last as long as so many steps should: a
/// sender that was stopped and pours out its backlog has recovered once it is back in its rhythm,
/// not before.
///
/// Detection of a silent input takes `lost` periods after its last step, so at most that after its
/// sender's death, plus what the receiver needs to look: see NextChange().
class InputHealth {
 public:
  /// @param period of the steps on the wall clock, above 0
  /// @param began when the input may be expected from
  InputHealth(const HealthSection& section, Duration period, TimePoint began);

  /// A message of step `step` has arrived. The step that is there already changes nothing; an older
  /// one is late and counted.
  void Arrived(std::int64_t step, TimePoint now);

  /// Takes the time into account. @return the state now
  InputState Update(TimePoint now);
  InputState state() const { return state_; }
  /// When Update() changes the state unless a step arrives; TimePoint::max() if it does not.
  TimePoint NextChange() const;

  /// Newest step that has arrived, -1 if none.
  std::int64_t newest() const { return newest_; }
  /// Time since the newest step arrived, or since the beginning.
  Duration Age(TimePoint now) const { return now - heard_; }
  /// Steps per second over the last kRateSteps arrivals; falls while none comes, 0 before two have.
  double RateHz(TimePoint now) const;
  /// Messages that came after a newer one of the same input had been used.
  std::int64_t late() const { return late_; }

  static constexpr std::size_t kRateSteps = 16;

 private:
  void Recover(TimePoint now);

  Duration stale_;
  Duration lost_;
  std::int64_t recover_steps_;
  Duration recover_time_;  // that so many steps last at least

  InputState state_ = InputState::kAwaited;
  std::int64_t newest_ = -1;
  TimePoint heard_;
  std::int64_t late_ = 0;
  // Steps in time without interruption, and when the first of them came.
  std::int64_t streak_ = 0;
  TimePoint streak_began_;
  // The last arrivals: a ring.
  std::array<TimePoint, kRateSteps> arrivals_{};
  std::size_t num_arrivals_ = 0;
  std::size_t next_arrival_ = 0;
};

}  // namespace fogline
