// Constants for the tests of studies.
#pragma once

#include <cstdint>
#include <limits>

namespace fogline {

// The value of a measure that a run does not have.
inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
inline constexpr std::int64_t kSeeds = 20;

}  // namespace fogline
