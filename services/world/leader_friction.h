// The strongest braking that the tyres of the preceding car allow.
#pragma once

#include "scenario/sections/scenario.h"
#include "services/models/vehicle/grade_profile.h"

namespace fogline::world {

/// The preceding car brakes with at most
///
///     g (mu cos(theta) + sin(theta)),   at least 0,
///
/// on a slope of angle theta; on a level road this limit is mu g. mu is the friction of
/// road.surface (services/models/vehicle). So this car and the vehicles behind it have the same
/// friction. A point mass has no tyres. If all other cars are point masses, the preceding car is a
/// point mass, too, and its braking has no limit.
class LeaderFriction {
 public:
  /// @throw InputError if the profile states a braking that is possible nowhere on this road
  LeaderFriction(const Scenario& scenario, models::GradeProfile road);

  /// The acceleration of the profile, limited to the braking that friction allows at this place.
  /// @param profile_mps2 acceleration of the profile
  double Limited(double profile_mps2, double position_m) const;

 private:
  bool has_tyres_;
  double friction_;
  models::GradeProfile road_;
};

}  // namespace fogline::world
