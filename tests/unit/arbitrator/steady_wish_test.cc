#include "services/arbitrator/steady_wish.h"

#include <cmath>
#include <initializer_list>

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr double kThreshold = 0.5;

double Step(SteadyWish& steady, double doc) { return steady.Step(Compare(doc, kThreshold), doc); }

TEST(SteadyWishTest, WithoutHysteresisIsTheComparison) {
  SteadyWish steady(TransferSection{}, 0.1);
  for (const double doc : {0.0, 0.5, 0.49, 1.0, 0.2}) {
    EXPECT_EQ(Step(steady, doc), doc >= kThreshold ? 1 : 0);
  }
}

TEST(SteadyWishTest, BandLetsTheAutomationReturnOnlyBelowIt) {
  SteadyWish steady({.hysteresis = Hysteresis::kBand, .band = 0.2}, 0.1);
  EXPECT_EQ(Step(steady, 0.49), 0);
  EXPECT_EQ(Step(steady, 0.5), 1);
  EXPECT_EQ(Step(steady, 0.31), 1);
  EXPECT_EQ(Step(steady, 0.29), 0);
  EXPECT_EQ(Step(steady, 0.49), 0);
}

// With DoC 0.9 against 0.5, L grows by ln 9 = 2.197 a step: past ln 99 = 4.595 with the third.
TEST(SteadyWishTest, SprtWaitsForEnoughEvidenceInEitherDirection) {
  SteadyWish steady({.hysteresis = Hysteresis::kSprt, .sprt_alpha = 0.01, .sprt_beta = 0.01}, 0.1);
  for (const double expected : {0.0, 0.0, 1.0, 1.0}) EXPECT_EQ(Step(steady, 0.9), expected);
  // One step of the next test has gone by; -ln 9 three times more leaves -4.39, a fourth is enough.
  for (const double expected : {1.0, 1.0, 1.0, 0.0}) EXPECT_EQ(Step(steady, 0.1), expected);
}

TEST(SteadyWishTest, SprtDecidesWithWaldsBounds) {
  SteadyWish eager({.hysteresis = Hysteresis::kSprt, .sprt_alpha = 0.2, .sprt_beta = 0.01}, 0.1);
  EXPECT_EQ(Step(eager, 0.84), 1) << "ln(0.99/0.2) = 1.60 < logit(0.84) = 1.66";
  SteadyWish slow({.hysteresis = Hysteresis::kSprt, .sprt_alpha = 0.2, .sprt_beta = 0.01}, 0.1);
  EXPECT_EQ(Step(slow, 0.82), 0) << "logit(0.82) = 1.52";
}

TEST(SteadyWishTest, SprtStaysFiniteWhereDocOrThresholdIsRoundedToOneOrNought) {
  SteadyWish steady({.hysteresis = Hysteresis::kSprt}, 0.1);
  EXPECT_EQ(steady.Step(Compare(1, 1), 1), 0) << "no evidence either way";
  EXPECT_EQ(steady.Step(Compare(1, 0), 1), 1);
  EXPECT_EQ(steady.Step(Compare(0, 1), 0), 0);
}

TEST(SteadyWishTest, StaysAtLeastItsTime) {
  SteadyWish steady({.min_dwell_s = 0.3}, 0.1);
  EXPECT_EQ(Step(steady, 1), 1) << "nothing to wait for before the first transfer";
  EXPECT_EQ(Step(steady, 0), 1);
  EXPECT_EQ(Step(steady, 0), 1);
  EXPECT_EQ(Step(steady, 0), 0);
  EXPECT_EQ(Step(steady, 1), 0);
}

TEST(SteadyWishTest, TakesTheWishOfTheMomentWhenTheStayIsOver) {
  SteadyWish steady({.min_dwell_s = 0.3}, 0.1);
  Step(steady, 1);
  Step(steady, 0);
  Step(steady, 0);
  EXPECT_EQ(Step(steady, 1), 1) << "the conflict is back";
}

TEST(SteadyWishTest, LetsAFirmWishPass) {
  SteadyWish steady({.hysteresis = Hysteresis::kBand, .band = 0.5, .min_dwell_s = 60}, 0.1);
  Step(steady, 1);
  EXPECT_EQ(steady.Step({.lambda_human = 0.25, .threshold = 0.5, .firm = true}, 1), 0.25);
}

}  // namespace
}  // namespace fogline
