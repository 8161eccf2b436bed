#include "tools/study/estimate.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/tools/study/examples.h"

namespace fogline {
namespace {

TEST(EstimateTest, IsTheMeanWithStudentsIntervalOfTheValuesThatAreThere) {
  // The three values have mean 2 and standard deviation 1. Student's t with 2 degrees of freedom is
  // 4.302653, so the interval is 2 +- 4.302653/sqrt(3).
  const study::Estimate estimate = study::EstimateOf(std::array{1.0, kNoNumber, 2.0, 3.0});
  EXPECT_EQ(estimate.n, 3);
  EXPECT_EQ(estimate.mean, 2);
  EXPECT_NEAR(estimate.low, 2 - 2.484138, 1e-6);
  EXPECT_NEAR(estimate.high, 2 + 2.484138, 1e-6);
}

TEST(EstimateTest, OfOneValueHasNoInterval) {
  const study::Estimate estimate = study::EstimateOf(std::array{5.0});
  EXPECT_EQ(estimate.mean, 5);
  EXPECT_TRUE(std::isnan(estimate.low));
  EXPECT_EQ(study::VerdictOf(estimate), study::Verdict::kTooFew);
  EXPECT_TRUE(std::isnan(study::EstimateOf({}).mean));
}

// If none of n values is 1, the bounds of Clopper & Pearson for the share of ones, at 97.5 %, are 0
// and 1 - 0.0125^(1/n).
TEST(EstimateTest, OfADifferenceOfSharesStaysBetweenMinusOneAndOneAndIsNotEmpty) {
  const std::vector<double> none(20, 0.0);
  const study::Estimate same = study::PairedShareDifference(none, none);
  EXPECT_EQ(same.mean, 0);
  EXPECT_NEAR(same.high, 1 - std::pow(0.0125, 1.0 / 20), 1e-9);
  EXPECT_EQ(same.low, -same.high);
  const study::Estimate all =
      study::PairedShareDifference(std::array{1.0, 1.0, 1.0}, std::array{0.0, 0.0, 0.0});
  EXPECT_EQ(all.mean, 1);
  EXPECT_NEAR(all.low, 2 * std::cbrt(0.0125) - 1, 1e-9);
  EXPECT_EQ(all.high, 1);
  EXPECT_FALSE(study::PairedShareDifference(std::array{1.0}, std::array{0.0}).has_interval());
}

TEST(EstimateTest, AnInfiniteValueIsNeitherMissingNorPartOfTheMean) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const study::Estimate estimate = study::EstimateOf(std::array{1.0, kInfinite, 3.0, kNoNumber});
  EXPECT_EQ(estimate.n, 2);
  EXPECT_EQ(estimate.mean, 2);
  EXPECT_EQ(estimate.infinite, 1);
  EXPECT_EQ(study::Text(study::EstimateOf(std::array{5.0, kInfinite}), 1), "5.0, ∞ in 1 of 2 runs");
  EXPECT_EQ(study::Text(study::EstimateOf(std::array{kInfinite, kInfinite}), 1),
            "∞ in 2 of 2 runs");
}

TEST(EstimateTest, IsToldWithAsManyDecimalsAsItsIntervalHas) {
  study::Estimate estimate{.n = 9, .mean = 0.0195, .deviation = 0, .low = 0.01942, .high = 0.01958};
  EXPECT_EQ(study::Text(estimate), "0.01950 [0.01942, 0.01958]");
  estimate = {.n = 9, .mean = 1191.75, .deviation = 0, .low = 1188.44, .high = 1195.06};
  EXPECT_EQ(study::Text(estimate), "1191.75 [1188.44, 1195.06]");
  estimate = {.n = 9, .mean = 0, .deviation = 0, .low = 0, .high = 0};
  EXPECT_EQ(study::Text(estimate), "0.00 [0.00, 0.00]");
}

TEST(PairedDifferenceTest, OfTwoInfiniteValuesIsNoneAndOfOneIsNotDecidedByTheOthers) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const study::Estimate both =
      study::PairedDifference(std::array{kInfinite, 3.0}, std::array{kInfinite, 3.0});
  EXPECT_EQ(both.n, 2);
  EXPECT_EQ(both.mean, 0);
  const study::Estimate one =
      study::PairedDifference(std::array{kInfinite, 3.0, 3.0}, std::array{2.0, 2.0, 2.0});
  EXPECT_EQ(one.n, 2);
  EXPECT_EQ(one.infinite, 1);
  EXPECT_EQ(study::VerdictOf(one), study::Verdict::kUndecided);
}

TEST(PairedDifferenceTest, IsKnownExactlyWhereOnlyTheNoiseOfThePairsDiffers) {
  const study::Estimate difference = study::PairedDifference(
      std::array{10.5, 90.5, 50.5, 7.0}, std::array{10.0, 90.0, 50.0, kNoNumber});
  EXPECT_EQ(difference.n, 3);
  EXPECT_EQ(difference.low, 0.5);
  EXPECT_EQ(difference.high, 0.5);
  EXPECT_EQ(study::VerdictOf(difference), study::Verdict::kMore);
}

TEST(VerdictTest, IsUndecidedWhereTheIntervalHasZeroInIt) {
  EXPECT_EQ(study::VerdictOf({.n = 9, .mean = 1, .deviation = 1, .low = -0.1, .high = 2.1}),
            study::Verdict::kUndecided);
  EXPECT_EQ(study::VerdictOf({.n = 9, .mean = 0, .deviation = 0, .low = 0, .high = 0}),
            study::Verdict::kUndecided);
  EXPECT_EQ(study::VerdictOf({.n = 9, .mean = -1, .deviation = 1, .low = -2, .high = -0.1}),
            study::Verdict::kLess);
}

// By hand: the mean is 1, the standard error is 1/2, and Student's t has three degrees of freedom.
// So t is 1 / (1/2) = 2 in the test of the sign, and (2 - 1) / (1/2) = 2 in the test of equality
// with the margin 2. P(T > 2) is 0.069663.
TEST(PValueTest, IsThatOfStudentsT) {
  const double root = std::sqrt(1.5);  // four values with mean 1 and standard deviation 1
  const std::vector<double> values{1 - root, 1, 1, 1 + root};
  const study::Estimate estimate = study::EstimateOf(values);
  ASSERT_NEAR(estimate.deviation, 1, 1e-12);
  constexpr double kTail = 0.069663;
  EXPECT_NEAR(study::PValueOfSign(estimate), 2 * kTail, 1e-6);
  EXPECT_NEAR(study::PValueOfEqual(estimate, 2), kTail, 1e-6);
  EXPECT_NEAR(study::PValueOfEqual(estimate, 0), 1 - kTail, 1e-6);
}

TEST(PValueTest, IsOneWithoutAnInterval) {
  EXPECT_EQ(study::PValueOfSign(study::EstimateOf(std::vector<double>{3})), 1);
  EXPECT_EQ(study::PValueOfEqual(study::EstimateOf(std::vector<double>{3}), 10), 1);
}

}  // namespace
}  // namespace fogline
