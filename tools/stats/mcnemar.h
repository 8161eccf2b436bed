// Test of pairs of yes/no values.
#pragma once

#include <span>

namespace fogline::stats {

/// Two-sided p-value of the exact test of McNemar (1947). A value above 0 is a "yes". The test uses
/// only the pairs with exactly one "yes". The null hypothesis: this "yes" is equally likely in `a`
/// and in `b`. The p-value is 1 if no pair has exactly one "yes".
/// @pre equal sizes
double McNemar(std::span<const double> a, std::span<const double> b);

}  // namespace fogline::stats
