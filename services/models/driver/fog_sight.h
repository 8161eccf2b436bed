// Sight of a driver in fog. The driver sees the outline of the car ahead if the car is near, and
// only the lamps if the car is further away. Beyond the range of the lamps, the driver sees
// nothing. The model also gives the distance and closing speed that the driver perceives.
#pragma once

#include "scenario/sections/human.h"
#include "services/models/driver/situation.h"

namespace fogline::models {

enum class Seen { kOutline, kLamps, kNothing };

/// The driver's sight. d is the gap, v the speed of the own car, v_l the speed of the car ahead,
/// and sigma = ln 20 / visibility the extinction (services/visibility.h). The driver sees the
/// outline, the lamps, or the closing under these conditions:
///
///     outline:  C_0 e^(-sigma d) >= eps           up to d_o = ln(C_0 / eps) / sigma (Koschmieder)
///     lamps:    I e^(-sigma d) / d^2 >= E_t       up to d_l                       (Allard 1876)
///     closing:  W |v - v_l| / d^2 > threshold
///
/// FogSightParameters has the other symbols: contrast C_0, contrast_threshold eps,
/// lamp_intensity_cd I, illuminance_threshold_lx E_t, angular_rate_threshold_radps (threshold), and
/// lamp_distance_factor kappa. W is body_width_m if the outline is visible, and lamp_separation_m
/// if only the lamps are visible. If the closing is not visible, the driver perceives a car ahead
/// with the speed v and the acceleration 0. The perceived distance is d up to clear_share d_o, and
/// kappa d from d_o on. Between these distances the factor grows linearly from 1 to kappa. The
/// range of the lamps is d_l = (2 / sigma) W_0(sigma / 2 sqrt(I / E_t)), with Lambert's W.
class FogSight {
 public:
  /// @throw std::invalid_argument for a parameter out of its range.
  explicit FogSight(const FogSightParameters& parameters);

  /// The distance up to which the driver sees the outline or the lamps of the car ahead, m.
  /// `visibility_m` is the meteorological optical range, above 0; infinity is clear air.
  double OutlineRange(double visibility_m) const;
  double LampRange(double visibility_m) const;
  Seen At(double gap_m, double visibility_m) const;

  /// The situation that the driver perceives. The driver knows the speed of the own car.
  Situation Perceive(const Situation& truth, double visibility_m) const;

 private:
  FogSightParameters parameters_;
};

}  // namespace fogline::models
