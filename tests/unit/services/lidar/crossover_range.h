// The range beyond which fog hides a target from a LiDAR, for published sets of parameters.
#pragma once

#include <cmath>
#include <numbers>

#include "services/lidar/fog_beam.h"

namespace fogline::test {

/// Range beyond which the echo of the fog is stronger than that of the target. There the ratio
///     rho = P_f / P_t = (pi beta / Gamma) J R^2 exp(2 alpha R)    (full overlap, R >= R2)
/// is 1, so the range is AttenuatedRange_m of sqrt(Gamma / (pi beta J)).
inline double CrossoverRange_m(double fog_strength_pm, double reflectivity, double backscatter_pmsr,
                               double extinction_pm) {
  return lidar::AttenuatedRange_m(
      std::sqrt(reflectivity / (std::numbers::pi * backscatter_pmsr * fog_strength_pm)),
      extinction_pm);
}

}  // namespace fogline::test
