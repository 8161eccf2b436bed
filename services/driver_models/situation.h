// What a driver, or a model of one, goes by.
#pragma once

#include <optional>

namespace fogline {

struct CarAhead {
  double gap_m = 0;  // bumper to bumper
  double speed_mps = 0;
  double acceleration_mps2 = 0;
};

/// Truth or perception of one driver at one moment.
struct Situation {
  double speed_mps = 0;  // the own
  double acceleration_mps2 = 0;
  std::optional<CarAhead> ahead;  // without one the road is free, as far as he can tell
};

}  // namespace fogline
