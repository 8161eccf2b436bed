// The standard normal distribution.
#pragma once

#include <cmath>
#include <numbers>

namespace fogline::conflict {

/// The probability of a value below `u`.
inline double NormalBelow(double u) { return std::erfc(-u / std::numbers::sqrt2) / 2; }

}  // namespace fogline::conflict
