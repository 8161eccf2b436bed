// Advanced emergency braking: the state machine that warns, brakes and releases, on what a car
// knows of the car ahead.
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
/// c > 0, a collision is imminent if
///
///     ttc           s <= ttc_s c
///     deceleration  c^2 >= 2 required_mps2 s
///
/// as the scenario's trigger says, and if the own speed is in the range of the system. A warning
/// begins if this holds for the gap that the cars have after warning_s, s - warning_s c. The
/// braking goes on, at any own speed, until c <= release_closing_mps, until no car ahead is seen,
/// or until the own car stands.
class Aeb {
 public:
  explicit Aeb(const AebSection& section) : section_(section) {}

  /// The state in this step. Call it once per step.
  AebState Step(const Situation& seen);
  AebState state() const { return state_; }

  /// The acceleration that is applied in this state, in place of `acceleration_mps2`.
  double Applied(double acceleration_mps2) const;

 private:
  bool Imminent(double gap_m, double closing_mps) const;
  AebState StateOf(const Situation& seen) const;

  AebSection section_;
  AebState state_ = AebState::kReady;
};

}  // namespace fogline::models
