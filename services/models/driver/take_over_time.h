// Distribution of the time from the request to take over until the driver takes over.
#pragma once

#include <cstdint>

#include "common/random.h"
#include "scenario/sections/take_over.h"

namespace fogline::models {

/// Take-over time T for a request with lead time t. A driver is late if T > t.
///
///     log-normal:  ln T ~ N(mu, s^2)    s^2 = ln(1 + std^2 / mean^2)    mu = ln mean - s^2 / 2
///     SUMO:        T ~ N(m, ((t - m) / z)^2), T >= 0    m = min(2 sqrt(t), 0.7 t)
///                  P(Z > z) = P(late)
///     by lead:     log-normal with mean m and P(T > t) = P(late):
///                  s = z - sqrt(z^2 - 2 ln(t / m))
///
/// mean, std and P(late) are mean_s, std_s and late_probability of TakeOverParameters. Z is a
/// standard normal number. In both models that use z, z is defined by P(Z > z) = P(late). SUMO
/// (MSDevice_ToC) draws again if a value is negative. After 100 negative values, SUMO takes the
/// mean. For a lead time of minutes, many values are negative and are drawn again, so P(T > t) is
/// larger than P(late). The standard deviation here is (t - m) / z. SUMO itself takes its standard
/// deviation from a table.
class TakeOverTime {
 public:
  /// @param lead_s t, above 0
  /// @throw std::invalid_argument for a parameter out of its range, or if no log-normal
  /// distribution has this P(late), because z^2 < 2 ln(t / m). No such distribution exists if
  /// P(late) is above 19.9 % for t up to 8.2 s, or above 5 % for t = 60 s.
  TakeOverTime(const TakeOverParameters& parameters, double lead_s);

  /// T in s for a request in this step. T depends only on `random` and the step, not on the order
  /// of calls.
  double Draw(const Random& random, std::int64_t step) const;

  /// The exact P(T > t).
  double LateProbability() const;

  /// The quantile q of T in s: P(T <= q) = `probability`. @param probability in (0, 1)
  double Quantile(double probability) const;

 private:
  bool normal_ = false;  // false: log-normal
  double lead_s_;
  double location_ = 0;  // mu, or m in s
  double scale_ = 0;     // s, or the standard deviation in s
};

}  // namespace fogline::models
