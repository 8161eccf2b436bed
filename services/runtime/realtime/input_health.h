// Judges the health of one input in real time by the arrival times of its steps on the receiver's
// own clock. Callers pass the time as an argument. This class reads no clock, and the clocks of the
// senders do not matter.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/clock.h"
#include "scenario/sections/realtime.h"
#include "services/input_state.h"

namespace fogline::runtime {

/// Age, rate and state of an input that brings one step in every period.
///
///     AWAITED --a step--> OK --age > stale--> STALE --age > lost--> LOST
///        |                 ^                    |                    |
///        +--age > lost--> LOST                  +-- recover_steps ---+--> OK
///
/// The age is the time since the last new step arrived, or since the beginning. The limits are
/// inclusive: an age of exactly `stale` is OK. An input is OK again after `recover_steps` new
/// steps. Each of these steps except the first must come within `stale` after the previous step.
/// Together, the steps must take at least recover_steps - stale_periods periods, which is nearly
/// the time that they take at the normal rate. So an input does not recover while its sender sends
/// a backlog after a stop. The input recovers when the sender sends at its normal rate again.
///
/// The loss of an input is detected `lost` periods after its last step. So the time from the
/// failure of the sender to the detection is `lost` periods at most, plus the time until the
/// receiver calls Update() (see NextChange()).
class InputHealth {
 public:
  /// @param period duration of a step on the wall clock, above 0
  /// @param began the time from which on the input is expected
  InputHealth(const HealthSection& section, Duration period, TimePoint began);

  /// Evaluates a message of step `step`. A repetition of the newest step changes nothing. An older
  /// step counts as late.
  void Arrived(std::int64_t step, TimePoint now);

  /// Updates the state to the time `now`. @return the state
  InputState Update(TimePoint now);
  InputState state() const { return state_; }
  /// When Update() will change the state if no step arrives; TimePoint::max() if Update() will not
  /// change the state.
  TimePoint NextChange() const;

  /// Newest step that has arrived, -1 if none.
  std::int64_t newest() const { return newest_; }
  /// Time since the newest step arrived, or since the beginning.
  Duration Age(TimePoint now) const { return now - heard_; }
  /// Steps per second over the last kRateSteps arrivals. The rate falls while no step comes. The
  /// rate is 0 before two steps have come.
  double RateHz(TimePoint now) const;
  /// Messages that came after a newer message of the same input.
  std::int64_t late() const { return late_; }

  static constexpr std::size_t kRateSteps = 16;

 private:
  void Recover(TimePoint now);

  Duration stale_;
  Duration lost_;
  std::int64_t recover_steps_;
  Duration recover_time_;  // the least time that recover_steps_ steps take

  InputState state_ = InputState::kAwaited;
  std::int64_t newest_ = -1;
  TimePoint heard_;
  std::int64_t late_ = 0;
  // The number of steps in a row that have come in time, and when the first of them came.
  std::int64_t streak_ = 0;
  TimePoint streak_began_;
  // The times of the last arrivals, as a ring.
  std::array<TimePoint, kRateSteps> arrivals_{};
  std::size_t num_arrivals_ = 0;
  std::size_t next_arrival_ = 0;
};

}  // namespace fogline::runtime
