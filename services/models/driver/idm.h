// The Intelligent Driver Model as a formula.
#pragma once

#include "scenario/sections/control.h"

namespace fogline::models {

/// Intelligent Driver Model (Treiber, Hennecke & Helbing, Physical Review E 62:1805, 2000):
///
///     a  = a_max [1 - (v / v_0)^delta - (s* / s)^2]
///     s* = s_0 + max(0, v T + v dv / (2 sqrt(a_max b)))
///
/// with v the own speed, dv = v - v_preceding the closing speed and s the gap, bumper to bumper.
/// The parameters are fields of DriverSection:
///
///     a_max = max_acceleration_mps2      b = comfortable_deceleration_mps2      delta = exponent
///     v_0 = desired_speed_mps            s_0 = standstill_m                     T = headway_s
///
/// Behind a car of equal speed, a is 0 at the gap (s_0 + v T) / sqrt(1 - (v / v_0)^delta).
///
/// If s goes to 0, the formula goes to minus infinity. This class never returns less than
/// -max_deceleration_mps2. For s <= 0, the formula has no meaning, and the result is
/// -max_deceleration_mps2.
class Idm {
 public:
  explicit Idm(const DriverSection& driver);

  /// Acceleration in m/s2, in [-max_deceleration_mps2, a_max]; finite for any finite input.
  /// @param speed_mps v; a negative value counts as 0
  double Acceleration(double speed_mps, double preceding_speed_mps, double gap_m) const;

  /// s* in m. @param speed_mps at least 0
  double DesiredGap(double speed_mps, double preceding_speed_mps) const;

 private:
  DriverSection driver_;
  double twice_sqrt_ab_mps2_;  // 2 sqrt(a_max b)
};

}  // namespace fogline::models
