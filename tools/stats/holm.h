// Adjusts the p-values of several tests for their number.
#pragma once

#include <span>
#include <vector>

namespace fogline::stats {

/// Holm's adjustment (1979). A null hypothesis is refused if its adjusted p-value is below a level.
/// The probability that any true null hypothesis is refused then stays below this level.
std::vector<double> Holm(std::span<const double> p);

}  // namespace fogline::stats
