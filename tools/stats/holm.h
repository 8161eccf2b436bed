// Adjusts the p-values of several tests for the number of tests.
#pragma once

#include <span>
#include <vector>

namespace fogline::stats {

/// Adjusts p-values by Holm's method (1979). A null hypothesis is rejected if its adjusted p-value
/// is below a level. Then the probability that any true null hypothesis is rejected is at most this
/// level.
std::vector<double> Holm(std::span<const double> p);

}  // namespace fogline::stats
