// The view of a driver behind another car, and the precision of accelerations, for tests.
#pragma once

#include "services/models/driver/following.h"

namespace fogline {

inline constexpr double kNear = 1e-12;  // some roundings of values around 1

inline models::Situation Behind(double speed_mps, double gap_m, double lead_mps,
                                double lead_mps2 = 0) {
  return {.speed_mps = speed_mps,
          .ahead = models::CarAhead{
              .gap_m = gap_m, .speed_mps = lead_mps, .acceleration_mps2 = lead_mps2}};
}

}  // namespace fogline
