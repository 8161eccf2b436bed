// Times of a scenario in whole steps.
#pragma once

#include <cmath>
#include <cstdint>

namespace fogline {

/// The least number of steps that is no shorter than `time_s` >= 0. A time that steps divide evenly
/// is not a step more because of the rounding of its quotient.
inline std::int64_t StepsUntil(double time_s, double step_s) {
  constexpr double kRounding = 1e-9;  // steps
  return static_cast<std::int64_t>(std::ceil(time_s / step_s - kRounding));
}

}  // namespace fogline
