#include "services/decision/conflict/over_time/sequential.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/services/decision/conflict/evidence.h"

namespace fogline {
namespace {

struct RunLength {
  double mean;            // steps
  double standard_error;  // of the mean
};

// The mean number of steps, over `runs` runs, until a CUSUM of either sign exceeds the threshold.
// The difference of the sensors has a variance of 1 m2.
RunLength TwoSidedRunLength(double threshold, double shift_m, int runs) {
  const Random random(3, Stream::kRadar);
  conflict::Cusum up({});
  conflict::Cusum down({});
  double sum = 0;
  double squares = 0;
  std::int64_t step = 0;
  for (int run = 0; run < runs; ++run) {
    up.Reset();
    down.Reset();
    int steps = 0;
    double largest = 0;
    while (largest <= threshold) {
      const double d = random.Normal2(step++, 0)[0] + shift_m;
      largest = std::max(up.Step(LidarShortBy(d, 0.6, 0.8)), down.Step(LidarShortBy(-d, 0.6, 0.8)));
      ++steps;
    }
    sum += steps;
    squares += double{1} * steps * steps;
  }
  const double mean = sum / runs;
  return {mean, std::sqrt((squares / runs - mean * mean) / runs)};
}

// The tolerances are 3.3 standard errors, the 99.9 % confidence interval. The random numbers are
// the same in each run of the tests, so a test that passes always passes.
constexpr double kConfidence = 3.3;

TEST(CusumTest, MeanRunLengthToAFalseAlarmIsTheQuotedOne) {
  const RunLength at_4 = TwoSidedRunLength(4, 0, 2000);
  EXPECT_NEAR(at_4.mean, 168, kConfidence * at_4.standard_error);
  EXPECT_LT(at_4.standard_error, 0.03 * at_4.mean);  // the estimate is precise to 3 %
  const RunLength at_5 = TwoSidedRunLength(5, 0, 1200);
  EXPECT_NEAR(at_5.mean, 465, kConfidence * at_5.standard_error);
  EXPECT_LT(at_5.standard_error, 0.035 * at_5.mean);
}

TEST(CusumTest, MeanRunLengthAfterAShiftByOneStandardDeviationIsTheQuotedOne) {
  const RunLength at_4 = TwoSidedRunLength(4, 1, 4000);
  EXPECT_NEAR(at_4.mean, 8.4, kConfidence * at_4.standard_error);
  const RunLength at_5 = TwoSidedRunLength(5, 1, 4000);
  EXPECT_NEAR(at_5.mean, 10.4, kConfidence * at_5.standard_error);
  EXPECT_LT(at_5.standard_error, 0.01 * at_5.mean);
}

TEST(CusumTest, AddsWhatExceedsKappaAndNeverFallsBelowZero) {
  conflict::Cusum measure({});
  EXPECT_EQ(measure.Step(LidarShortBy(-5, 3, 4)), 0);
  EXPECT_EQ(measure.Step(LidarShortBy(10, 3, 4)), 1.5);
  EXPECT_EQ(measure.Step(LidarShortBy(5, 3, 4)), 2);
  EXPECT_EQ(measure.Step(LidarShortBy(0, 3, 4)), 1.5);
}

TEST(CusumTest, ComesDownFromALongFaultWithinTheCeilingOverKappa) {
  conflict::ConflictParameters parameters;
  conflict::Cusum measure(parameters);
  for (int i = 0; i < 1000; ++i) measure.Step(LidarShortBy(20));
  const int steps = static_cast<int>(parameters.cusum_ceiling / parameters.cusum_kappa);
  double score = parameters.cusum_ceiling;
  for (int i = 0; i < steps; ++i) score = measure.Step(LidarShortBy(0));
  EXPECT_EQ(score, 0);
}

TEST(GlrTest, FindsTheJumpWhereverItBegan) {
  conflict::Glr measure({});
  double score = 0;
  for (int i = 0; i < 10; ++i) measure.Step(LidarShortBy(0, 3, 4));
  for (int i = 0; i < 6; ++i) score = measure.Step(LidarShortBy(10, 3, 4));
  EXPECT_NEAR(score, 6 * 2.0 * 2.0 / 2, 1e-12);  // n (b/sqrt(S))^2/2, with b = 10 m, S = 25 m2
}

TEST(GlrTest, LooksNoFurtherBackThanItsWindow) {
  conflict::ConflictParameters parameters;
  parameters.glr_window_steps = 3;
  conflict::Glr measure(parameters);
  double score = 0;
  for (int i = 0; i < 50; ++i) score = measure.Step(LidarShortBy(5, 3, 4));
  EXPECT_NEAR(score, 1.5, 1e-12);
}

TEST(SprtTest, HasWaldsThresholds) {
  const conflict::SprtBounds bounds = conflict::WaldBounds(0.01, 0.05);
  EXPECT_NEAR(bounds.accept_conflict, std::log(95.0), 1e-12);
  EXPECT_NEAR(bounds.accept_agreement, std::log(5.0 / 99), 1e-12);
}

TEST(SprtTest, AddsTheLogLikelihoodRatioOfAStep) {
  conflict::ConflictParameters parameters;  // delta = 0.5 m
  conflict::Sprt measure(parameters);
  EXPECT_NEAR(measure.Step(LidarShortBy(1.25, 3, 4)), 0.5 / 25 * (1.25 - 0.25), 1e-15);
  EXPECT_NEAR(measure.Step(LidarShortBy(0.25, 3, 4)), 0.5 / 25 * (1.25 - 0.25), 1e-15);
}

TEST(SprtTest, ErrsNoMoreOftenThanItsParametersSay) {
  constexpr int kTests = 4000;
  conflict::ConflictParameters parameters;
  parameters.sprt_delta_m = 1;
  const conflict::SprtBounds bounds =
      conflict::WaldBounds(parameters.sprt_alpha, parameters.sprt_beta);
  const Random random(4, Stream::kRadar);
  // The share of the kTests tests that decide for the conflict.
  const auto accepted = [&](double shift_m) {
    conflict::Sprt measure(parameters);
    std::int64_t step = 0;
    int conflicts = 0;
    for (int i = 0; i < kTests; ++i) {
      measure.Reset();
      double score = 0;
      while (score > bounds.accept_agreement && score < bounds.accept_conflict) {
        score = measure.Step(UnitNoise(random, step++, shift_m));
      }
      if (score >= bounds.accept_conflict) ++conflicts;
    }
    return conflicts / double{kTests};
  };
  // Wald's inequality, plus 3.3 standard errors of a share of 1 % in 4000 tests.
  const double margin = kConfidence * std::sqrt(0.01 * 0.99 / kTests);
  EXPECT_LE(accepted(0), parameters.sprt_alpha / (1 - parameters.sprt_beta) + margin);
  EXPECT_GE(accepted(parameters.sprt_delta_m), 1 - parameters.sprt_beta / 0.99 - margin);
}

}  // namespace
}  // namespace fogline
