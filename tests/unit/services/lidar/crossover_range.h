// The range of a LiDAR in fog, and the range beyond which fog hides a target.
#pragma once

#include <cmath>
#include <numbers>

#include <boost/math/special_functions/lambert_w.hpp>

namespace fogline::test {

/// The largest range at which a LiDAR detects a target in fog. In clear air it detects this target
/// up to R_c = `clear_range_m`. With alpha = `extinction_pm`, the largest range R solves
/// (R / R_c)^2 exp(2 alpha R) = 1, that is R exp(alpha R) = R_c. With Lambert's W,
/// R = W(alpha R_c) / alpha.
inline double AttenuatedRange_m(double clear_range_m, double extinction_pm) {
  if (extinction_pm == 0.0) return clear_range_m;
  return boost::math::lambert_w0(extinction_pm * clear_range_m) / extinction_pm;
}

/// Range beyond which the echo of the fog is stronger than the echo of the target. The ratio of the
/// two powers is
///     rho = P_f / P_t = (pi beta / Gamma) J R^2 exp(2 alpha R)    (full overlap, R >= R2).
/// At the crossover range rho is 1. So this range is AttenuatedRange_m of
/// sqrt(Gamma / (pi beta J)). J is `fog_strength_pm`, Gamma `reflectivity`, beta
/// `backscatter_pmsr`, and alpha `extinction_pm`. R2 is the range from which transmitter and
/// receiver overlap fully.
inline double CrossoverRange_m(double fog_strength_pm, double reflectivity, double backscatter_pmsr,
                               double extinction_pm) {
  return AttenuatedRange_m(
      std::sqrt(reflectivity / (std::numbers::pi * backscatter_pmsr * fog_strength_pm)),
      extinction_pm);
}

}  // namespace fogline::test
