#include "services/models/driver/take_over_time.h"

#include <cstdint>

#include <gtest/gtest.h>
#include <boost/math/distributions/binomial.hpp>

namespace fogline {
namespace {

constexpr std::int64_t kDraws = 10'000;
constexpr double kAlpha = 1e-4;  // probability of a false alarm, on either side

using Binomial = boost::math::binomial_distribution<>;

void ExpectLateWithin(const TakeOverParameters& parameters, double lead_s) {
  const models::TakeOverTime time(parameters, lead_s);
  const Random random(1, Stream::kTakeOver);
  std::int64_t late = 0;
  for (std::int64_t step = 0; step < kDraws; ++step) {
    const double drawn_s = time.Draw(random, step);
    ASSERT_GE(drawn_s, 0);
    if (drawn_s > lead_s) ++late;
  }
  // The confidence bounds of Clopper & Pearson (1934).
  const double n = static_cast<double>(kDraws);
  const double k = static_cast<double>(late);
  EXPECT_LE(Binomial::find_lower_bound_on_p(n, k, kAlpha), time.LateProbability()) << lead_s;
  EXPECT_GE(Binomial::find_upper_bound_on_p(n, k, kAlpha), time.LateProbability()) << lead_s;
}

TEST(TakeOverTimeProperty, IsLateAsOftenAsItsParameterWithinTheBoundOfTenThousandDraws) {
  for (const double lead_s : {2.0, 5.0, 10.0, 30.0}) {
    for (const double p : {0.01, 0.05}) {
      ExpectLateWithin({.model = TakeOverModel::kLogNormalByLead, .late_probability = p}, lead_s);
      ExpectLateWithin({.model = TakeOverModel::kSumo, .late_probability = p}, lead_s);
    }
    ExpectLateWithin({}, lead_s);
  }
}

TEST(TakeOverTimeProperty, HasTheMeanAndDeviationAskedFor) {
  const models::TakeOverTime time({.mean_s = 4.57, .std_s = 1.63}, 10);
  const Random random(2, Stream::kTakeOver);
  double sum = 0;
  double squares = 0;
  for (std::int64_t step = 0; step < kDraws; ++step) {
    const double drawn_s = time.Draw(random, step);
    sum += drawn_s;
    squares += drawn_s * drawn_s;
  }
  const double mean = sum / kDraws;
  // Each tolerance is four standard deviations of the estimate. The standard deviation of the
  // estimated mean is 1.63 / sqrt(n). The relative standard deviation of the estimated standard
  // deviation is sqrt((5.3 - 1) / (4 n)), because the log-normal variable has a kurtosis of about
  // 5.3 here.
  EXPECT_NEAR(mean, 4.57, 4 * 1.63 / 100);
  EXPECT_NEAR(std::sqrt(squares / kDraws - mean * mean), 1.63, 4 * 1.63 * 0.0104);
}

}  // namespace
}  // namespace fogline
