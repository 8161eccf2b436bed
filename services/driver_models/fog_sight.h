// What fog leaves of the car ahead for a human eye: first its outline, further away its lamps, and
// then nothing; and how far off and how fast closing he takes it to be.
#pragma once

#include "scenario/human.h"
#include "services/driver_models/situation.h"

namespace fogline {

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
