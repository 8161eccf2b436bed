// Advanced emergency braking: the state machine that warns, brakes and releases. The state machine
// uses only values that a car can know of the car ahead.
#pragma once

#include <cstdint>

#include "scenario/sections/aeb.h"
#include "services/models/driver/situation.h"

namespace fogline::models {

enum class AebState : std::uint8_t {
  kReady,
  kWarning,  // a collision will be imminent within warning_s
  kBraking,
};

/// Emergency braking after UN Regulation No. 152, 5.2.1 (car to car). With gap s and closing speed
/// c > 0, there are two conditions for an imminent collision:
///
///     ttc           s <= ttc_s c
///     deceleration  c^2 >= 2 required_mps2 s
///
/// The scenario's trigger says which conditions must be met. The own speed must also be between
/// min_speed_mps and max_speed_mps, and c must be above release_closing_mps. A warning begins if a
/// collision would be imminent at the gap s - warning_s c, which the cars will have after
/// warning_s. The braking continues at any own speed. The braking ends if c is at most
/// release_closing_mps, if no car ahead is seen, or if the own car stands.
class Aeb {
 public:
  explicit Aeb(const AebSection& section) : section_(section) {}

  /// The state in this step. Call Step() once per step.
  AebState Step(const Situation& seen);
  AebState state() const { return state_; }

  /// The acceleration that this state applies in place of the command `acceleration_mps2`.
  double Applied(double acceleration_mps2) const;

 private:
  bool Imminent(double gap_m, double closing_mps) const;
  AebState StateOf(const Situation& seen) const;

  AebSection section_;
  AebState state_ = AebState::kReady;
};

}  // namespace fogline::models
