// The rows of `fogline table` and the curves of `fogline report`, computed with a progress bar.
#pragma once

#include <span>
#include <vector>

#include "tools/sweep/threshold_curve.h"

namespace fogline::cli {

/// SweepThresholds() on all cores with a progress bar. Call WatchInterrupts() before it.
/// @throws Interrupted after Ctrl-C
std::vector<sweep::ThresholdRow> RowsOnAllCores(const Scenario& scenario,
                                                std::span<const double> thresholds,
                                                const sweep::SeedRange& seeds);

}  // namespace fogline::cli
