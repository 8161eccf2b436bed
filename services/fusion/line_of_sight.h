// Measurement model of a range sensor with a lateral offset.
#pragma once

#include <cmath>

#include "services/fusion/ekf.h"

namespace fogline::fusion {

/// The line from a sensor to the target's reflection point at distance d ahead and y to the side:
///
///     range        r = sqrt(d^2 + y^2)        dr/dd = d / r
///     range rate     = dv d / r               d/dd = dv y^2 / r^3,   d/ddv = d / r
///
/// With y = 0, range and range rate are linear: r = d, and the range rate is dv. If an estimate has
/// d < 0, the range counts as negative. The next measurement then pulls the estimate back to the
/// front. If the range were positive, the estimate could stay at the mirror image of the target
/// behind the sensor.
class LineOfSight {
 public:
  LineOfSight(double distance_m, double lateral_offset_m) {
    if (lateral_offset_m == 0) {  // same result as below, without root and divisions
      if (std::abs(distance_m) >= kTouching_m) range_m_ = distance_m;
      return;
    }
    const double range = std::copysign(
        std::sqrt(distance_m * distance_m + lateral_offset_m * lateral_offset_m), distance_m);
    if (std::abs(range) < kTouching_m) return;
    range_m_ = range;
    cosine_ = distance_m / range;
    cosine_slope_per_m_ = lateral_offset_m * lateral_offset_m / (range * range * range);
  }

  double range_m() const { return range_m_; }
  double RangeRate(double relative_speed_mps) const { return relative_speed_mps * cosine_; }

  /// d / r, the derivative of the range with respect to the distance.
  double cosine() const { return cosine_; }

  Ekf::Jacobian RangeJacobian() const { return {cosine_, 0}; }
  Ekf::Jacobian RangeRateJacobian(double relative_speed_mps) const {
    return {relative_speed_mps * cosine_slope_per_m_, cosine_};
  }

 private:
  // At a smaller range, rounding errors determine most of the direction, so the target counts as
  // straight ahead.
  static constexpr double kTouching_m = 1e-9;

  double range_m_ = 0;
  double cosine_ = 1;
  double cosine_slope_per_m_ = 0;  // dcosine/dd
};

}  // namespace fogline::fusion
