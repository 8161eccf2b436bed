// Whether the numbers of a STATUS can be true: it comes from the network or from a file, and what
// is summed up or subtracted must not overflow.
#pragma once

#include "fogline/status_t.hpp"

namespace fogline {

/// False if a process cannot have counted so far, or a step or time cannot be of a run. Sums of the
/// counters of many STATUS messages, and differences of their times, do not overflow otherwise.
bool IsPossible(const status_t& status);

}  // namespace fogline
