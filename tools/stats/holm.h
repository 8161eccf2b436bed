// Adjusts the p-values of several tests for their number.
#pragma once

#include <span>
#include <vector>

namespace fogline::stats {

/// Holm's adjustment (1979). If a null hypothesis counts as refused when its adjusted p-value is
/// below a level, the probability that any true one is refused stays below this level.
std::vector<double> Holm(std::span<const double> p);

}  // namespace fogline::stats
