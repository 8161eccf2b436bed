// Checks of a sensor's random errors over many seeds and steps. Each check compares a statistic of
// the errors with bounds. For a correct sensor, the statistic is beyond a bound with a probability
// of 1e-6. Each bound is a quantile of the statistic's exact distribution. Only ExpectUniform()
// uses an approximate distribution, which needs many samples.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>

namespace fogline::test {

inline constexpr double kRare = 1e-6;
inline constexpr double kRareSigmas = 4.75;  // the quantile of the normal distribution for kRare
inline constexpr int kSeeds = 40;
inline constexpr int kSteps = 250;
inline constexpr int kSamples = kSeeds * kSteps;

/// Expects mean 0 and standard deviation 1.
inline void ExpectStandardNormalMoments(const std::vector<double>& z) {
  const auto n = static_cast<double>(z.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double value : z) {
    sum += value;
    squares += value * value;
  }
  EXPECT_LT(std::abs(sum), kRareSigmas * std::sqrt(n));
  const boost::math::chi_squared chi_squared(n);
  EXPECT_GT(squares, quantile(chi_squared, kRare));
  EXPECT_LT(squares, quantile(complement(chi_squared, kRare)));
}

/// Expects values that are uniform in [0, 1), by Pearson's test over 20 cells.
inline void ExpectUniform(const std::vector<double>& shares) {
  constexpr int kCells = 20;
  std::vector<int> counts(kCells);
  for (const double share : shares) ++counts.at(static_cast<std::size_t>(share * kCells));
  const double expected = static_cast<double>(shares.size()) / kCells;
  double statistic = 0.0;
  for (const int count : counts) statistic += (count - expected) * (count - expected) / expected;
  EXPECT_LT(statistic, quantile(complement(boost::math::chi_squared(kCells - 1), kRare)));
}

/// Expects that `count` events in kSamples samples fit this probability of an event.
inline void ExpectShare(int count, double probability, const char* what) {
  const boost::math::binomial binomial(kSamples, probability);
  EXPECT_GE(count, quantile(binomial, kRare)) << what;
  EXPECT_LE(count, quantile(complement(binomial, kRare))) << what;
}

}  // namespace fogline::test
