// Everything that is compared. A file for each family of comparisons.
#pragma once

#include <vector>

#include "tools/benchmarks/comparison.h"

namespace fogline {

/// How much is measured.
enum class Effort { kQuick, kFull };

/// The lockstep over udpm and memq beside bare LCM processes and hops.
std::vector<Comparison> LockstepComparisons(Effort effort);

/// Runs in one process, beside programs that others use for the same.
std::vector<Comparison> PeerComparisons(Effort effort);

/// Sweeps and logs: cores, memory, reading speed.
std::vector<Comparison> DataComparisons(Effort effort);

}  // namespace fogline
