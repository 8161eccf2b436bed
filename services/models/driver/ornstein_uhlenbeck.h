// Correlated noise, because an error of perception lasts for some time.
#pragma once

#include <cmath>

namespace fogline::models {

/// Ornstein-Uhlenbeck process of mean 0, variance 1 and correlation e^(-t / tau). The steps are
/// exact (Gillespie, Physical Review E 54:2084, 1996):
///
///     w' = e^(-h / tau) w + sqrt(1 - e^(-2 h / tau)) eta          eta ~ N(0, 1)
///
/// w is the value of the process, w' its next value, h the length of a step, and eta a standard
/// normal random number. The process begins with w = eta, in the stationary distribution.
class OrnsteinUhlenbeck {
 public:
  /// @param correlation_time_s tau, above 0
  OrnsteinUhlenbeck(double correlation_time_s, double step_s)
      : keep_(std::exp(-step_s / correlation_time_s)),
        add_(std::sqrt(-std::expm1(-2.0 * step_s / correlation_time_s))) {}

  /// w of the next step. @param normal eta
  double Step(double normal) {
    value_ = begun_ ? keep_ * value_ + add_ * normal : normal;
    begun_ = true;
    return value_;
  }

 private:
  double keep_;
  double add_;
  double value_ = 0;
  bool begun_ = false;
};

}  // namespace fogline::models
