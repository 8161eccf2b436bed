// Three rules for the safe distance behind a car: the rule of RSS, and two rules of the fuzzy
// safety model.
#pragma once

#include "services/models/driver/situation.h"

namespace fogline::models {

/// Responsibility-Sensitive Safety (Shalev-Shwartz, Shammah & Shashua, arXiv 1708.06374, 2017).
/// Defaults: the values that ad-rss-lib suggests for the vehicle behind (appendix "Parameter
/// Discussion"). An exception is the response time: the default is the value for the ego vehicle.
struct RssParameters {
  double response_s = 1.0;          // rho, at least 0
  double acceleration_mps2 = 3.5;   // a_acc during the response, at least 0
  double least_braking_mps2 = 4.0;  // b_min of the car behind after the response, above 0
  double most_braking_mps2 = 8.0;   // b_max of the car ahead, above 0
};

/// Safe distance of RSS in m, with the own speed v and the speed v_l of the car ahead:
///     d_min = max(0, v rho + a_acc rho^2 / 2 + (v + rho a_acc)^2 / (2 b_min) - v_l^2 / (2 b_max))
double RssSafeDistance(const RssParameters& rss, double speed_mps, double lead_speed_mps);

/// Fuzzy safety model (Mattas, Makridis, Botzoris, Kriston, Minarini, Papadopoulos, Re, Rognelund &
/// Ciuffo, Accident Analysis & Prevention 148:105794, 2020). Defaults: the values that UN R157
/// uses, as published by the JRC (JRC-FSM).
struct FuzzyParameters {
  double response_s = 0.75;             // rho, at least 0
  double comfortable_braking_mps2 = 4;  // b_c, above 0
  double hard_braking_mps2 = 6;         // b_h, above b_c
  double lead_braking_mps2 = 7;         // b_l, above 0
  double standstill_m = 2;              // d_1, gap that remains at rest, at least 0
  double safe_margin_m = 2;             // d_2, extra distance that is entirely safe, at least 0
};

/// Proactive fuzzy surrogate PFS. PFS assumes that the car ahead brakes with b_l. PFS is 0 if
/// comfortable braking of the own car is then sufficient, and 1 if even hard braking is not
/// sufficient. Between these cases, PFS is linear in the distance s - d_1, from 0 at d_safe to 1 at
/// d_unsafe. s is the gap, v the own speed, and v_l the speed of the car ahead:
///
///     d_safe   = v rho + v^2 / (2 b_c) - v_l^2 / (2 b_l) + d_2
///     d_unsafe = v rho + v^2 / (2 b_h) - v_l^2 / (2 b_l)
double ProactiveFuzzy(const FuzzyParameters& fuzzy, const Situation& seen);

/// Critical fuzzy surrogate CFS. CFS assumes that the car ahead keeps its speed. It also assumes
/// that the own acceleration a stays constant during the response; a below -b_c counts as -b_c. The
/// closing speed after the response is c' = v + a rho - v_l. If v <= v_l, CFS is 0. Otherwise CFS
/// is computed like PFS, but with the gap s in place of the distance s - d_1, and with
///
///     d_safe   = (v + a rho / 2 - v_l) rho + c'^2 / (2 b_c)      d_unsafe: b_h in place of b_c
///
/// If c' < 0, the own car already brakes so hard that the closing ends during the response. CFS is
/// then 1 if s is below (v - v_l)^2 / (2 |a_0|), otherwise 0. a_0 is the own acceleration without
/// the limit -b_c.
double CriticalFuzzy(const FuzzyParameters& fuzzy, const Situation& seen);

/// Deceleration in m/s2 that the model demands, 0 if none: b_c + CFS (b_h - b_c) if CFS > 0,
/// otherwise PFS b_c.
double FuzzyDeceleration(const FuzzyParameters& fuzzy, const Situation& seen);

}  // namespace fogline::models
