// The number that distinguishes a seat from all other seats.
#pragma once

#include <cstdint>

namespace fogline::runtime {

/// Draws the `instance` of a seat's DRIVER_INPUT: a random number that is not 0.
std::int64_t DrawSeatInstance();

}  // namespace fogline::runtime
