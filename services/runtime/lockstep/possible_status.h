// Checks whether the numbers of a STATUS can be true. A STATUS comes from the network or from a
// file, so its numbers may be wrong. Sums and differences of these numbers must not overflow.
#pragma once

#include "fogline/status_t.hpp"

namespace fogline::runtime {

/// Returns false if a counter is negative or higher than any process can count, or if a step or
/// time is outside the range of all runs. If all STATUS messages are possible, sums of their
/// counters and differences of their times do not overflow.
bool IsPossible(const status_t& status);

}  // namespace fogline::runtime
