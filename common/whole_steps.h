// Times in whole steps, rounded down or up. If the quotient of time and step differs from a whole
// number only by rounding, the result is this whole number. So 0.3 s is three steps of 0.1 s,
// although the quotient of these doubles is a little less than 3.
#pragma once

#include <cmath>
#include <cstdint>

namespace fogline {

/// Largest difference from a whole number that counts as a rounding error, in steps.
inline constexpr double kStepRounding = 1e-9;

/// Number of whole steps in a time.
inline double WholeSteps(double time_s, double step_s) {
  return std::floor(time_s / step_s + kStepRounding);
}

/// The least number of steps that together last at least `time_s` >= 0.
inline std::int64_t StepsUntil(double time_s, double step_s) {
  return static_cast<std::int64_t>(std::ceil(time_s / step_s - kStepRounding));
}

}  // namespace fogline
