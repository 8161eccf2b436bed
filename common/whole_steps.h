// Times of a scenario in whole steps.
#pragma once

#include <cmath>
#include <cstdint>

namespace fogline {

/// The least number of steps that together last at least `time_s` >= 0. If the quotient of time and
/// step exceeds a whole number only by rounding, it counts as this whole number.
inline std::int64_t StepsUntil(double time_s, double step_s) {
  constexpr double kRounding = 1e-9;  // steps
  return static_cast<std::int64_t>(std::ceil(time_s / step_s - kRounding));
}

}  // namespace fogline
