// All comparisons. Each family of comparisons has its own file.
#pragma once

#include <filesystem>
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

/// This build, compared with that of another commit.
/// @param folder the other commit's sources in folder/source, its build in folder/build
std::vector<Comparison> AgainstComparisons(Effort effort, const std::filesystem::path& folder);

}  // namespace fogline::benchmarks
