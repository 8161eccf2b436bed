#include "services/fusion/gate.h"

#include <boost/math/distributions/chi_squared.hpp>

namespace fogline::fusion {

Gate::Gate(double probability, std::int64_t reopen_after)
    : limit_(boost::math::quantile(boost::math::chi_squared(1), probability)),
      reopen_after_(reopen_after) {}

bool Gate::Admits(double normalised_innovation_squared) {
  if (normalised_innovation_squared <= limit_) {
    refusals_ = 0;
    return true;
  }
  if (reopen_after_ == 0) return false;
  if (refusals_ >= reopen_after_) return true;
  ++refusals_;
  return false;
}

}  // namespace fogline::fusion
