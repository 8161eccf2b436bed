#include "services/models/driver/take_over_time.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <boost/math/special_functions/erf.hpp>

namespace fogline::models {
namespace {

constexpr std::uint32_t kSumoDraws = 100;

// P(Z > z) of the standard normal distribution, and its inverse.
double UpperTail(double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); }
double UpperQuantile(double probability) {
  return std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * probability);
}

double SumoMean_s(double lead_s) { return std::min(2.0 * std::sqrt(lead_s), 0.7 * lead_s); }

void Require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

}  // namespace

TakeOverTime::TakeOverTime(const TakeOverParameters& parameters, double lead_s)
    : normal_(parameters.model == TakeOverModel::kSumo), lead_s_(lead_s) {
  Require(lead_s > 0.0, "take-over time: the lead time is not above 0");
  if (parameters.model == TakeOverModel::kLogNormal) {
    Require(parameters.mean_s > 0.0 && parameters.std_s > 0.0,
            "take-over time: mean and standard deviation are not above 0");
    const double ratio = parameters.std_s / parameters.mean_s;
    scale_ = std::sqrt(std::log1p(ratio * ratio));
    location_ = std::log(parameters.mean_s) - 0.5 * scale_ * scale_;
    return;
  }
  Require(parameters.late_probability > 0.0 && parameters.late_probability < 0.5,
          "take-over time: the probability of being late is outside (0, 0.5)");
  const double mean_s = SumoMean_s(lead_s);
  const double z = UpperQuantile(parameters.late_probability);
  if (normal_) {
    location_ = mean_s;
    scale_ = (lead_s - mean_s) / z;
    return;
  }
  const double spare = z * z - 2.0 * std::log(lead_s / mean_s);
  Require(spare >= 0.0,
          "take-over time: no log-normal distribution has so large a probability of being late");
  scale_ = z - std::sqrt(spare);
  location_ = std::log(mean_s) - 0.5 * scale_ * scale_;
}

double TakeOverTime::Draw(const Random& random, std::int64_t step) const {
  if (!normal_) return std::exp(location_ + scale_ * random.Normal2(step, 0)[0]);
  for (std::uint32_t draw = 0; draw < kSumoDraws; ++draw) {
    const double time_s = location_ + scale_ * random.Normal2(step, draw)[0];
    if (time_s >= 0.0) return time_s;
  }
  return location_;
}

double TakeOverTime::LateProbability() const {
  if (!normal_) return UpperTail((std::log(lead_s_) - location_) / scale_);
  return UpperTail((lead_s_ - location_) / scale_) / UpperTail(-location_ / scale_);
}

double TakeOverTime::Quantile(double probability) const {
  if (!normal_) return std::exp(location_ + scale_ * UpperQuantile(1.0 - probability));
  const double above_0 = UpperTail(-location_ / scale_);  // values below 0 are drawn again
  return location_ + scale_ * UpperQuantile((1.0 - probability) * above_0);
}

}  // namespace fogline::models
