// Chooses the driver of each following car: as the scenario says, or drawn with its seed.
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

/// The driver of this following car; the car behind the host has number 0. Random choices are drawn
/// for each car independently. So a further car, or other parameters of a car, do not change the
/// drivers of the other cars.
DriverAssignment AssignmentOf(const Scenario& scenario, std::size_t car);

}  // namespace fogline::follower
