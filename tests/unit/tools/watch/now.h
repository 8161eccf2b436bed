// A time in the tests of `fogline top`.
#pragma once

#include <chrono>

#include "common/clock.h"

namespace fogline {

inline constexpr TimePoint kNow{std::chrono::hours(1)};

}  // namespace fogline
