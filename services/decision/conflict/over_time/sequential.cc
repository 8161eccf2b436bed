#include "services/decision/conflict/over_time/sequential.h"

#include <algorithm>
#include <cmath>

namespace fogline::conflict {

Cusum::Cusum(const ConflictParameters& parameters)
    : source_(parameters), kappa_(parameters.cusum_kappa), ceiling_(parameters.cusum_ceiling) {}

double Cusum::Step(const Evidence& evidence) {
  const std::optional<Disagreement> disagreement = source_.Next(evidence);
  if (disagreement) {
    sum_ = std::clamp(sum_ + disagreement->standardised() - kappa_, 0.0, ceiling_);
  }
  return sum_;
}

void Cusum::Reset() {
  source_.Reset();
  sum_ = 0;
}

double LargestJump(const Window& standardised) {
  double sum = 0;
  int count = 0;
  double largest = 0;
  standardised.ForEachBackwards([&](double u) {
    sum += u;
    ++count;
    largest = std::max(largest, sum * sum / (2 * count));
  });
  return largest;
}

SprtBounds WaldBounds(double alpha, double beta) {
  return {.accept_agreement = std::log(beta / (1 - alpha)),
          .accept_conflict = std::log((1 - beta) / alpha)};
}

Sprt::Sprt(const ConflictParameters& parameters)
    : source_(parameters),
      bounds_(WaldBounds(parameters.sprt_alpha, parameters.sprt_beta)),
      delta_m_(parameters.sprt_delta_m),
      ceiling_(parameters.sprt_ceiling * bounds_.accept_conflict) {}

double Sprt::Step(const Evidence& evidence) {
  const std::optional<Disagreement> disagreement = source_.Next(evidence);
  if (disagreement) {
    const double gain_pm = delta_m_ / disagreement->variance_m2();
    const double increment = gain_pm * (disagreement->difference_m - delta_m_ / 2);
    log_ratio_ = std::clamp(log_ratio_ + increment, bounds_.accept_agreement, ceiling_);
  }
  return log_ratio_;
}

void Sprt::Reset() {
  source_.Reset();
  log_ratio_ = 0;
}

}  // namespace fogline::conflict
