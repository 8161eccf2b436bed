// The action of a driver of a following car, and the emergency braking of this car. All kinds of
// driver use this file.
#pragma once

#include <optional>

#include "scenario/sections/traffic.h"
#include "services/models/aeb/aeb.h"

namespace fogline::follower {

/// The emergency braking of a following car; nullopt if the following cars have no emergency
/// braking.
inline std::optional<models::Aeb> AebOf(const FollowersSection& followers) {
  if (!followers.aeb.enabled) return std::nullopt;
  return models::Aeb(followers.aeb);
}

/// The action of a driver in a step.
struct DriverAction {
  double acceleration_mps2 = 0;
  double safe_distance_m = 0;  // T_hw v + d_0 of this driver at the present speed
};

}  // namespace fogline::follower
