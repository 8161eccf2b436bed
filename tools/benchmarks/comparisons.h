// All comparisons. Each family of comparisons has its own file.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/benchmarks/comparison.h"

namespace fogline::benchmarks {

/// How long the measurements take.
enum class Effort { kQuick, kFull };

/// The lockstep over udpm and over memq, each compared with bare LCM over the same transport.
std::vector<Comparison> LockstepComparisons(Effort effort);

/// Runs in one process, compared with other programs for the same purpose.
std::vector<Comparison> PeerComparisons(Effort effort);

/// Sweeps and logs: effect of a second core, memory of a sweep, and speed of reading a log.
std::vector<Comparison> DataComparisons(Effort effort);

/// This build compared with the build of another commit.
/// @param folder the sources of the other commit are in folder/source, its build is in folder/build
std::vector<Comparison> AgainstComparisons(Effort effort, const std::filesystem::path& folder);

}  // namespace fogline::benchmarks
