// Times and periods of the tests of runs in real time.
#pragma once

#include <chrono>
#include <cstdint>

#include "common/clock.h"

namespace fogline {

inline constexpr Duration kPeriod = milliseconds(100);
inline constexpr TimePoint kBegan{std::chrono::hours(5)};

/// The time `ms` after kBegan.
inline TimePoint At(std::int64_t ms) { return kBegan + milliseconds(ms); }

// A speed at which a period lasts a second. A test takes much less time, so its duration does not
// matter.
inline constexpr double kSlowSpeed = 0.1;
inline constexpr Duration kSlowPeriod = milliseconds(1000);

}  // namespace fogline
