// What fog leaves of the car ahead for a human eye: first its outline, further away its lamps, and
// then nothing; and how far off and how fast closing he takes it to be.
#pragma once

#include "services/driver_models/situation.h"

namespace fogline {

struct FogSightParameters {
  /// C_0, contrast of the car against the fog from nearby, above 0 to 1. Estimate for a grey car;
  /// 1 is black.
  double contrast = 0.5;

  /// eps, the least contrast that is seen, above 0, below C_0. WMO's definition of visibility:
  /// 0.05.
  double contrast_threshold = 0.05;

  /// Share of the outline's range up to which distances are judged rightly, 0 to 1. Estimate: a
  /// clear outline wants a contrast of 0.1 to 0.2.
  double clear_share = 0.5;

  /// kappa, perceived over true distance where only lamps are seen, at least 1. Cavallo and others
  /// (2001 and before) found 30 to 60 % too much; the middle.
  double lamp_distance_factor = 1.45;

  /// I in cd, above 0. A tail lamp: 5; a rear fog lamp: 150 to 300 (UN R7, R38).
  double lamp_intensity_cd = 5.0;

  /// E_t in lx, above 0: least illuminance at the eye that is seen. 1e-6 by night, 1e-4 to 1e-3 at
  /// dusk and by day.
  double illuminance_threshold_lx = 1e-4;

  /// Least angular rate in rad/s that is seen as closing in or falling back, at least 0. Hoffmann &
  /// Mortimer (1994 and 1996): 0.003.
  double angular_rate_threshold_radps = 0.003;

  /// W in m, above 0: of the body, and between the lamps. Estimate: usual cars.
  double body_width_m = 1.8;
  double lamp_separation_m = 1.3;
};

enum class Seen { kOutline, kLamps, kNothing };

/// With extinction sigma = ln 20 / visibility (services/world/visibility.h):
///
///     outline:  C_0 e^(-sigma d) >= eps           up to d_o = ln(C_0 / eps) / sigma (Koschmieder)
///     lamps:    I e^(-sigma d) / d^2 >= E_t       up to d_l                            (Allard
///     1876) closing:  W |v - v_l| / d^2 > threshold     otherwise v_l is taken for v, and steady
///
/// and the distance d is taken for d up to a share of d_o, from there on for ever more, for kappa d
/// from d_o on. d_l = (2 / sigma) W_0(sigma / 2 sqrt(I / E_t)) with Lambert's W.
class FogSight {
 public:
  /// @throw std::invalid_argument for a parameter out of its range.
  explicit FogSight(const FogSightParameters& parameters);

  /// In air of this meteorological optical range, above 0; infinity is clear air.
  double OutlineRange(double visibility_m) const;
  double LampRange(double visibility_m) const;
  Seen At(double gap_m, double visibility_m) const;

  /// What of the truth reaches the driver. His own speed he knows.
  Situation Perceive(const Situation& truth, double visibility_m) const;

 private:
  FogSightParameters parameters_;
};

/// The speed in m/s from which a car still stops within what is seen, with reaction time tau and
/// deceleration b: v tau + v^2 / (2 b) = range.
double SpeedForSightDistance(double range_m, double reaction_time_s, double deceleration_mps2);

}  // namespace fogline
