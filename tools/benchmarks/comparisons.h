// All comparisons. Each family of comparisons has its own file.
#pragma once

#include <vector>

#include "tools/benchmarks/comparison.h"

namespace fogline::benchmarks {

/// How long the measurements take.
enum class Effort { kQuick, kFull };

/// The lockstep over udpm and memq, compared with bare LCM over udpm and memq.
std::vector<Comparison> LockstepComparisons(Effort effort);

/// Runs in one process, compared with other programs for the same purpose.
std::vector<Comparison> PeerComparisons(Effort effort);

/// Sweeps and logs: cores, memory, reading speed.
std::vector<Comparison> DataComparisons(Effort effort);

}  // namespace fogline::benchmarks
