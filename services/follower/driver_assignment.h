// Chooses the driver of each following car. The scenario names the driver, or the driver is drawn
// with the scenario's seed.
#pragma once

#include <cstddef>

#include "scenario/sections/scenario.h"
#include "services/models/follower/style.h"

namespace fogline::follower {

/// Driver of a following car.
struct DriverAssignment {
  bool has_acc = true;
  models::Style style = models::Style::kNormal;  // style of a person; without effect for an ACC
};

/// The driver of this following car; the car directly behind the host has number 0. Each car has
/// its own random draw. So an additional car, or a change to one car, does not change the drivers
/// of the other cars.
DriverAssignment AssignmentOf(const Scenario& scenario, std::size_t car);

}  // namespace fogline::follower
