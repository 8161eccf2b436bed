#include "services/fusion/adaptive_noise.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/random.h"

namespace fogline {
namespace {

constexpr double kAssumed = 0.04;  // the assumed variance of the noise

TEST(AdaptiveNoiseTest, IsTheAssumedOneUntilItLearns) {
  for (const NoiseAdaptation rule :
       {NoiseAdaptation::kNone, NoiseAdaptation::kInnovation, NoiseAdaptation::kResidual}) {
    EXPECT_EQ(fusion::AdaptiveNoise(rule, kAssumed, 0.3).variance(), kAssumed);
  }
}

TEST(AdaptiveNoiseTest, LearnsNothingIfItIsOff) {
  fusion::AdaptiveNoise noise(NoiseAdaptation::kNone, kAssumed, 0.3);
  noise.Learn({.innovation = 9, .predicted_variance = 0.1, .residual = 9});
  EXPECT_EQ(noise.variance(), kAssumed);
}

TEST(AdaptiveNoiseTest, FollowsTheSquaredInnovationLessTheVarianceOfThePrediction) {
  fusion::AdaptiveNoise noise(NoiseAdaptation::kInnovation, kAssumed, 0.3);
  noise.Learn({.innovation = -2, .predicted_variance = 0.5, .residual = 100});
  EXPECT_DOUBLE_EQ(noise.variance(), 0.3 * 0.04 + 0.7 * 3.5);
  noise.Learn({.innovation = 1, .predicted_variance = 0.5});
  EXPECT_DOUBLE_EQ(noise.variance(), 0.3 * (0.3 * 0.04 + 0.7 * 3.5) + 0.7 * 0.5);
}

TEST(AdaptiveNoiseTest, FollowsTheSquaredResidualPlusTheVarianceOfTheEstimate) {
  fusion::AdaptiveNoise noise(NoiseAdaptation::kResidual, kAssumed, 0.3);
  noise.Learn({.innovation = 100, .residual = -2, .corrected_variance = 0.5});
  EXPECT_DOUBLE_EQ(noise.variance(), 0.3 * 0.04 + 0.7 * 4.5);
}

TEST(AdaptiveNoiseTest, NeverFallsBelowTheAssumedOne) {
  fusion::AdaptiveNoise innovation(NoiseAdaptation::kInnovation, kAssumed, 0);
  innovation.Learn({.innovation = 0.1, .predicted_variance = 5});
  EXPECT_EQ(innovation.variance(), kAssumed) << "the term is -4.99 m2";
  fusion::AdaptiveNoise residual(NoiseAdaptation::kResidual, kAssumed, 0);
  residual.Learn({.residual = 0.1, .corrected_variance = 0.001});
  EXPECT_EQ(residual.variance(), kAssumed);
}

TEST(AdaptiveNoiseTest, KeepsItsEstimateForeverIfNothingIsForgotten) {
  fusion::AdaptiveNoise noise(NoiseAdaptation::kResidual, kAssumed, 1);
  for (int i = 0; i < 100; ++i) noise.Learn({.residual = 10, .corrected_variance = 1});
  EXPECT_EQ(noise.variance(), kAssumed);
}

// A scalar random walk with a variance of 0.25 per step, measured with noise of variance 4. The
// filter assumes a noise variance of 1. With a long memory both rules find the true noise.
TEST(AdaptiveNoiseTest, FindsTheNoiseThatIsReallyThere) {
  constexpr double kWalk = 0.25;
  constexpr double kTrueNoise = 4;
  constexpr int kSteps = 40'000;
  for (const NoiseAdaptation rule : {NoiseAdaptation::kInnovation, NoiseAdaptation::kResidual}) {
    const Random random(1, Stream::kRadar);
    fusion::AdaptiveNoise noise(rule, 1, 0.99);
    double truth = 0;
    double estimate = 0;
    double variance = 1;
    double sum = 0;
    for (int k = 0; k < kSteps; ++k) {
      const auto [walk, error] = random.Normal2(k, 0);
      truth += std::sqrt(kWalk) * walk;
      variance += kWalk;
      const double measured = truth + std::sqrt(kTrueNoise) * error;
      const double predicted_variance = variance;
      const double innovation = measured - estimate;
      const double gain = variance / (variance + noise.variance());
      estimate += gain * innovation;
      variance *= 1 - gain;
      noise.Learn({.innovation = innovation,
                   .predicted_variance = predicted_variance,
                   .residual = measured - estimate,
                   .corrected_variance = variance});
      sum += noise.variance();
    }
    // The sum is over 40,000 steps, and nearly every step adds one squared value. So the standard
    // deviation of the mean is at least about 4 sqrt(2/40000) = 0.028. The tolerance is 5 % of the
    // true noise, which is seven times 0.028.
    EXPECT_NEAR(sum / kSteps, kTrueNoise, 0.2);
  }
}

}  // namespace
}  // namespace fogline
