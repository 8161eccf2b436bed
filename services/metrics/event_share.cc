#include "services/metrics/event_share.h"

#include <stdexcept>

#include <boost/math/distributions/binomial.hpp>

namespace fogline::metrics {

EventShare ClopperPearson(std::int64_t events, std::int64_t runs, double confidence) {
  if (events < 0 || runs < 1 || events > runs || !(confidence > 0 && confidence < 1)) {
    throw std::invalid_argument("Clopper-Pearson: events, runs or confidence out of range");
  }
  using Binomial = boost::math::binomial_distribution<>;
  const double tail = (1 - confidence) / 2;
  const auto n = static_cast<double>(runs);
  const auto k = static_cast<double>(events);
  return {.events = events,
          .runs = runs,
          .share = k / n,
          .lower = Binomial::find_lower_bound_on_p(n, k, tail),
          .upper = Binomial::find_upper_bound_on_p(n, k, tail)};
}

}  // namespace fogline::metrics
