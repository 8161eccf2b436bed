// Times counted in steps.
#pragma once

#include <cmath>

namespace fogline {

/// Number of whole steps in a time. 0.3 s is three steps of 0.1 s, although the quotient of these
/// doubles may be a little less than 3: a step that lacks at most 1e-9 of its length counts as
/// whole.
inline double WholeSteps(double time_s, double step_s) {
  constexpr double kRounding = 1e-9;
  return std::floor(time_s / step_s + kRounding);
}

}  // namespace fogline
