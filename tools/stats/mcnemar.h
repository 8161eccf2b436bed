// Test of pairs of yes/no values.
#pragma once

#include <span>

namespace fogline::stats {

/// Two-sided p-value of the exact test of McNemar (1947): if both sides are alike, a pair that is
/// "yes" (above 0) on one side only is equally likely to be so on either. 1 without such a pair.
/// @pre equal sizes
double McNemar(std::span<const double> a, std::span<const double> b);

}  // namespace fogline::stats
