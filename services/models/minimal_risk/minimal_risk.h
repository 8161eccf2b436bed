// The minimal risk manoeuvre: a car without automation and human comes to a standstill in its lane.
// The manoeuvre uses only the state of the car itself, because every other input may have failed.
#pragma once

#include "scenario/sections/scenario.h"

namespace fogline::models {

/// Brakes to standstill. The limits are d for the deceleration and j for the jerk. The manoeuvre
/// starts from the applied acceleration. a is the previous command, v > 0 is the speed, and h is
/// the length of a step. The command of the step is
///
///     a'   = max(a - j h, -d, -r(v))           but at most a + j h
///     r(v) = v/(n h) + (n - 1) j h/2          n = ceil((sqrt(1 + 8 v/(j h^2)) - 1)/2)
///
/// r(v) is the strongest braking from which the car can still come to rest smoothly. In each later
/// step the braking then falls by j h, and the car comes to rest exactly at the end of a step. In n
/// steps, the brakings r, r - j h, ... reduce the speed by v, and the last braking is at most j h.
/// So the end is as smooth as the beginning. In two cases the car exceeds a limit, but by as little
/// as possible:
///
/// - A car that brakes harder than d at the start releases the brake at the rate j, down to d.
/// - A car that brakes harder than r(v) at the start (a car that is about to stand) stops before
///   the brake is released. The car's acceleration then jumps to 0.
///
/// No function ends the manoeuvre, because UN R157, 5.5.5, allows another activation of the
/// automation only after a new run cycle. At standstill, the command is 0, and the car does not
/// roll backwards.
class MinimalRisk {
 public:
  /// @param step_s h, above 0
  MinimalRisk(const MinimalRiskSection& limits, double step_s);

  /// Begins the manoeuvre with this applied acceleration. Only the first call has an effect.
  void Begin(double acceleration_mps2);
  bool begun() const { return begun_; }

  /// The acceleration for the step that begins here. Call Step() once per step. @pre begun()
  /// @param speed_mps measured at the beginning of the step, at least 0
  double Step(double speed_mps) { return Step(speed_mps, limits_.deceleration_mps2); }
  /// As Step(speed_mps), but with this deceleration d, which may change from step to step. The
  /// limit on jerk still applies.
  /// @param deceleration_mps2 above 0, at most the deceleration of the limits
  double Step(double speed_mps, double deceleration_mps2);

 private:
  /// r(v) of the class comment: the strongest braking from which the car can still come to rest
  /// smoothly.
  double Releasable(double speed_mps) const;

  MinimalRiskSection limits_;
  double step_s_;
  bool begun_ = false;
  double acceleration_mps2_ = 0;  // at first the applied acceleration, then the last command
};

}  // namespace fogline::models
