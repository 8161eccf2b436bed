#include "tools/stats/mcnemar.h"

#include <algorithm>
#include <cstddef>

#include <boost/math/distributions/binomial.hpp>

namespace fogline::stats {

double McNemar(std::span<const double> a, std::span<const double> b) {
  double only_a = 0;
  double only_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    only_a += a[i] > 0 && !(b[i] > 0) ? 1 : 0;
    only_b += b[i] > 0 && !(a[i] > 0) ? 1 : 0;
  }
  if (only_a + only_b == 0) return 1;
  constexpr double kEven = 0.5;
  const boost::math::binomial_distribution<double> pairs(only_a + only_b, kEven);
  return std::min(1.0, 2 * boost::math::cdf(pairs, std::min(only_a, only_b)));
}

}  // namespace fogline::stats
