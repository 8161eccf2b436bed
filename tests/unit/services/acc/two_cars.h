// Two cars on a straight road, one behind the other. They move as in the world: the commanded
// acceleration acts from one step to the next, and no car drives backwards.
#pragma once

#include <algorithm>

#include "services/acc/acc_controller.h"

namespace fogline {

inline constexpr double kStep_s = 0.1;

struct TwoCars {
  double gap_m;
  double preceding_speed_mps;
  double speed_mps;
  double acceleration_mps2 = 0;  // applied during the last step
  double step_s = kStep_s;

  acc::AccController::Input Sense() const {
    return {.distance_m = gap_m,
            .relative_speed_mps = preceding_speed_mps - speed_mps,
            .speed_mps = speed_mps,
            .acceleration_mps2 = acceleration_mps2,
            .has_target = true};
  }

  void Advance(double command_mps2, double preceding_acceleration_mps2 = 0) {
    const double preceding = std::max(preceding_acceleration_mps2, -preceding_speed_mps / step_s);
    const double own = std::max(command_mps2, -speed_mps / step_s);
    const double half = 0.5 * step_s * step_s;
    gap_m += (preceding_speed_mps - speed_mps) * step_s + half * (preceding - own);
    preceding_speed_mps += preceding * step_s;
    speed_mps += own * step_s;
    acceleration_mps2 = own;
  }
};

}  // namespace fogline
