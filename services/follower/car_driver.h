// The driver of one car that follows another car.
#pragma once

#include <cstdint>
#include <optional>

#include "scenario/sections/traffic.h"
#include "services/models/aeb/aeb.h"
#include "services/models/driver/situation.h"

namespace fogline::follower {

/// The emergency braking of a following car; nullopt if the following cars have no emergency
/// braking.
inline std::optional<models::Aeb> AebOf(const FollowersSection& followers) {
  if (!followers.aeb.enabled) return std::nullopt;
  return models::Aeb(followers.aeb);
}

class CarDriver {
 public:
  struct Action {
    double acceleration_mps2 = 0;
    double safe_distance_m = 0;  // T_hw v + d_0 of this driver at the present speed
  };

  virtual ~CarDriver() = default;

  /// The driver's action in this step. Call Step() once per step, in the order of steps.
  /// @param now the truth, with a car ahead
  /// @param visibility_m meteorological optical range
  virtual Action Step(std::int64_t step, const models::Situation& now, double visibility_m) = 0;
};

}  // namespace fogline::follower
