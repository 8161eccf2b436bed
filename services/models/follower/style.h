// Styles of drivers, and the random choice of a style for each following car.
#pragma once

#include <cstdint>

#include "common/random.h"
#include "scenario/sections/control.h"
#include "services/models/driver/human_driver.h"

namespace fogline::models {

enum class Style { kAggressive, kNormal, kCautious };

struct StyleParameters {
  DriverSection driver;
  HumanParameters human;
};

/// The parameters of a style, from these sources:
/// - Time gaps of 1.25, 1.45 and 1.75 s: openpilot's aggressive, standard and relaxed following.
/// - Desired speeds, accelerations, decelerations and standstill gaps: after the driver classes of
///   Kesting, Treiber & Helbing, Agents for Traffic Simulation, 2009 (for the normal class
///   120 km/h, 1.4 and 2.0 m/s2, 2 m). The table of this source was not available, so these values
///   were not checked.
/// - Reaction times: our estimate, in the range of 0.5 to 1.1 s that the authors of the Human
///   Driver Model examine.
StyleParameters ParametersOf(Style style);

/// Relative frequency of each style. Every frequency is at least 0, and at least one frequency is
/// above 0.
struct StyleShares {
  double aggressive = 1;
  double normal = 1;
  double cautious = 1;
};

/// The style of the following car with this number; the numbers begin with 0. The style depends
/// only on shares, seed and number of the car.
/// @throw std::invalid_argument if a share is negative, or all shares are 0.
Style DrawStyle(const StyleShares& shares, const Random& random, std::int64_t follower);

/// A random choice for this following car: true with the probability `share`, in [0, 1]. The choice
/// depends only on share, seed and number of the car, and is independent of the car's style.
bool DrawChance(double share, const Random& random, std::int64_t follower);

}  // namespace fogline::models
