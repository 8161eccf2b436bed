#include "services/models/driver/ornstein_uhlenbeck.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "common/random.h"

namespace fogline {
namespace {

constexpr std::int64_t kProcesses = 20'000;
constexpr double kDeviations = 4;  // standard deviations; exceeded by chance once in 16,000 cases

struct Moments {
  double mean = 0;
  double variance = 0;
  double covariance = 0;  // covariance with the first value
};

// Moments over independent processes after `steps` steps.
Moments After(std::int64_t steps, double correlation_time_s, double step_s) {
  Moments m;
  for (std::int64_t i = 0; i < kProcesses; ++i) {
    const Random random(i, Stream::kHumanErrors);
    models::OrnsteinUhlenbeck process(correlation_time_s, step_s);
    const double first = process.Step(random.Normal2(0, 0)[0]);
    double last = first;
    for (std::int64_t k = 1; k <= steps; ++k) last = process.Step(random.Normal2(k, 0)[0]);
    m.mean += last / kProcesses;
    m.variance += last * last / kProcesses;
    m.covariance += first * last / kProcesses;
  }
  return m;
}

TEST(OrnsteinUhlenbeckProperty, KeepsVarianceOneAndForgetsExponentially) {
  const double n = kProcesses;
  for (const std::int64_t steps : {0, 1, 3, 10, 40}) {
    const Moments m = After(steps, 2.0, 0.25);
    const double correlation = std::exp(-0.125 * static_cast<double>(steps));
    // The standard deviations of the estimated mean, variance and covariance are 1 / sqrt(n),
    // sqrt(2 / n) and sqrt((1 + correlation^2) / n).
    EXPECT_NEAR(m.mean, 0, kDeviations / std::sqrt(n)) << steps;
    EXPECT_NEAR(m.variance, 1, kDeviations * std::sqrt(2 / n)) << steps;
    EXPECT_NEAR(m.covariance, correlation,
                kDeviations * std::sqrt((1 + correlation * correlation) / n))
        << steps;
  }
}

TEST(OrnsteinUhlenbeckProperty, CorrelatesTheSameOverATimeWithAnyStep) {
  const double n = kProcesses;
  const double expected = std::exp(-0.5);
  const double bound = kDeviations * std::sqrt((1 + expected * expected) / n);
  EXPECT_NEAR(After(1, 2.0, 1.0).covariance, expected, bound);
  EXPECT_NEAR(After(20, 2.0, 0.05).covariance, expected, bound);
}

}  // namespace
}  // namespace fogline
