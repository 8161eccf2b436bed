// Time and density of the fog. The models of the sensors and of the driver compute the effects of
// the fog.
#pragma once

#include <cstdint>

#include "scenario/sections/road.h"

namespace fogline::world {

/// Fog at one moment.
struct Fog {
  bool present = false;
  double level = 0;  // in [0, 1]
  double visibility_m = 0;
};

/// Level of a profile at x in [0, 1). x is the share of the fog window that has passed.
double FogLevel(FogProfile profile, double x);

/// The fog of a scenario. Times are compared in whole microseconds. In seconds, the binary rounding
/// of 0.1 could decide whether a step belongs to the fog window. The end of the window does not
/// belong to the window.
class FogSchedule {
 public:
  explicit FogSchedule(const FogSection& fog);

  /// The fog at `utime` microseconds after the start of the run. With the models beam and modes,
  /// the extinction grows linearly with the level, from clear air at level 0 to the scenario's fog
  /// at level 1. With the other models, the visibility is always the visibility of clear air.
  Fog At(std::int64_t utime) const;

 private:
  FogSection fog_;
  std::int64_t start_us_;
  std::int64_t duration_us_;
};

}  // namespace fogline::world
