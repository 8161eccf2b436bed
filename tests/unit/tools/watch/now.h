// The time that the tests of `fogline top` use as the present.
#pragma once

#include <chrono>

#include "common/clock.h"

namespace fogline {

inline constexpr TimePoint kNow{std::chrono::hours(1)};

}  // namespace fogline
