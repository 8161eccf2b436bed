// The minimal risk manoeuvre: how a car that nobody drives any more comes to a standstill in its
// lane. It looks at nothing but the car itself, for whatever else it would need may be what failed.
#pragma once

#include "scenario/scenario.h"

namespace fogline {

/// Braking within limits on deceleration d and jerk j, from the acceleration that is applied now to
/// rest. The command of a step of length h, from the one before it, a, and the speed v > 0, is
///
///     a'   = max(a - j h, -d, -r(v))           or, where even that is more than a + j h, a + j h
///     r(v) = v/(n h) + (n - 1) j h/2          n = ceil((sqrt(1 + 8 v/(j h^2)) - 1)/2)
///
/// r(v) is the braking that can still be released at the rate j, one step at a time, so that the
/// car stands exactly when a step ends: n steps of r, r - j h, r - 2 j h, ... add up to v, and the
/// last of them is at most j h. So the end is as smooth as the beginning, without a snap. Two cases
/// leave a limit, each as little as can be:
///   - a car that brakes harder than d now releases the brake at the rate j, down to d;
///   - a car that brakes harder than r(v) now (it is about to stand) stops before the brake is
///     released, with that jump.
///
/// Once begun it ends with the process: UN R157, 5.5.5, allows another activation only after a new
/// run cycle. A car that stands is held with the command 0 and does not roll backwards.
class MinimalRisk {
 public:
  /// @param step_s h, above 0
  MinimalRisk(const MinimalRiskSection& limits, double step_s);

  /// Begins at this applied acceleration. Nothing begins it a second time.
  void Begin(double acceleration_mps2);
  bool begun() const { return begun_; }

  /// The acceleration for the step that begins here. Once per step. @pre begun()
  /// @param speed_mps measured now, at least 0
  double Step(double speed_mps) { return Step(speed_mps, limits_.deceleration_mps2); }
  /// The same with another deceleration d, which may change from step to step: the manoeuvre goes
  /// on within the limit on jerk.
  /// @param deceleration_mps2 above 0, at most that of the limits
  double Step(double speed_mps, double deceleration_mps2);

 private:
  /// r(v).
  double Releasable(double speed_mps) const;

  MinimalRiskSection limits_;
  double step_s_;
  bool begun_ = false;
  double acceleration_mps2_ = 0;  // applied when it began, then as last commanded
};

}  // namespace fogline
