// Drivers of different temper, and which of them follows.
#pragma once

#include <cstdint>

#include "scenario/control.h"
#include "services/driver_models/human_driver.h"
#include "services/runtime/random.h"

namespace fogline {

enum class Style { kAggressive, kNormal, kCautious };

struct StyleParameters {
  DriverSection driver;
  HumanParameters human;
};

/// Headways: openpilot's aggressive, standard and relaxed following, 1.25, 1.45 and 1.75 s.
/// Desired speeds, accelerations, decelerations and standstill gaps: after the driver classes of
/// Kesting, Treiber & Helbing, Agents for Traffic Simulation, 2009 (120 km/h, 1.4 and 2.0 m/s2, 2 m
/// for the normal one; the table was not at hand). Reaction times: estimate, over the 0.5 to 1.1 s
/// that the Human Driver Model's authors look at.
StyleParameters ParametersOf(Style style);

/// How common each style is; at least 0, not all of them 0.
struct StyleShares {
  double aggressive = 1;
  double normal = 1;
  double cautious = 1;
};

/// The style of this following car, counted from 0: the same under the same seed, whoever asks.
/// @throw std::invalid_argument if shares are none.
Style DrawStyle(const StyleShares& shares, const Random& random, std::int64_t follower);

/// True of this share of following cars, in [0, 1]; independent of their styles, and as constant.
bool DrawChance(double share, const Random& random, std::int64_t follower);

}  // namespace fogline
