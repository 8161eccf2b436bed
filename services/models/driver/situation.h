// The situation that a driver, or a model of a driver, uses.
#pragma once

#include <optional>

namespace fogline::models {

struct CarAhead {
  double gap_m = 0;  // bumper to bumper
  double speed_mps = 0;
  double acceleration_mps2 = 0;
};

/// The true situation of one driver at one moment, or the situation that the driver perceives.
struct Situation {
  double speed_mps = 0;  // speed of the own car
  double acceleration_mps2 = 0;
  std::optional<CarAhead> ahead;  // empty if the driver sees no car ahead
};

}  // namespace fogline::models
