// The rows of `fogline table` and the curves of `fogline report`, computed for a person who waits.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "tools/sweep/threshold_curve.h"

namespace fogline {

/// Refuses a scenario in which no threshold matters. `file` is where it comes from.
/// @throws InputError
void RequireTradedControl(const Scenario& scenario, const std::filesystem::path& file);

/// SweepThresholds() on all cores with a progress bar; needs WatchInterrupts() before.
/// @throws Interrupted after Ctrl-C
std::vector<ThresholdRow> RowsOnAllCores(const Scenario& scenario,
                                         std::span<const double> thresholds,
                                         const SeedRange& seeds);

}  // namespace fogline
