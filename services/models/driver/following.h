// Car-following models, such as the IDM, which compute the acceleration of a driver. This file has
// only formulas; fog_sight.h and human_driver.h compute the situation that the driver perceives.
#pragma once

#include "scenario/sections/control.h"
#include "scenario/sections/human.h"
#include "services/models/driver/idm.h"
#include "services/models/driver/situation.h"

namespace fogline::models {

/// The IDM (idm.h), and the two models that Kesting, Treiber & Helbing (Philosophical Transactions
/// of the Royal Society A 368:4585, 2010) and Treiber & Kesting (Traffic Flow Dynamics, 2013)
/// derived from it. s* and the parameters are those of idm.h, and z = s* / s.
///
/// Improved IDM (IIDM); its equilibrium gap below v_0 is exactly s_0 + v T:
///
///     v <= v_0:  a_free = a_max [1 - (v / v_0)^delta]
///                a = a_max (1 - z^2)                        z >= 1
///                a = a_free (1 - z^(2 a_max / a_free))      z < 1
///     v > v_0:   a_free = -b [1 - (v_0 / v)^(a_max delta / b)]
///                a = a_free + a_max (1 - z^2)               z >= 1
///                a = a_free                                 z < 1
///
/// ACC-IDM. If a faster car cuts in at a short gap, this model does not brake hard, because the
/// faster car increases the gap by itself. ACC-IDM uses the constant-acceleration heuristic a_CAH.
/// v_l is the speed of the car ahead, and a~ = min(a_lead, a_max):
///
///     a_CAH = v^2 a~ / (v_l^2 - 2 s a~)                     v_l (v - v_l) <= -2 s a~
///     a_CAH = a~ - max(v - v_l, 0)^2 / (2 s)                else
///     a = a_IIDM                                            a_IIDM >= a_CAH
///     a = (1 - c) a_IIDM + c [a_CAH + b tanh((a_IIDM - a_CAH) / b)]      else
///
/// with the coolness c in [0, 1]. c = 0 gives the IIDM; Kesting et al. 2010 use 0.99.
///
/// As in the IDM, max_deceleration_mps2 is the strongest braking, and the braking at a gap <= 0.
class Following {
 public:
  static constexpr double kPapersCoolness = 0.99;

  /// @throw std::invalid_argument if coolness is outside [0, 1].
  Following(FollowingModel model, const DriverSection& driver, double coolness = kPapersCoolness);

  /// Acceleration in m/s2, in [-max_deceleration_mps2, a_max]; finite for any finite situation.
  double Acceleration(const Situation& seen) const;

 private:
  double FreeRoad(double speed_mps) const;
  double Improved(double speed_mps, const CarAhead& ahead) const;
  double ConstantAccelerationHeuristic(double speed_mps, const CarAhead& ahead) const;
  double Adaptive(double speed_mps, const CarAhead& ahead) const;

  FollowingModel model_;
  DriverSection driver_;
  double coolness_;
  Idm idm_;
};

}  // namespace fogline::models
