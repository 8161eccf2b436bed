#include "services/arbitrator/request_debouncer.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr double kThreshold = 0.5;

double Step(arbitrator::RequestDebouncer& debouncer, double doc) {
  return debouncer.Step(policies::Compare(doc, kThreshold), doc);
}

TEST(RequestDebouncerTest, WithoutHysteresisIsTheComparison) {
  arbitrator::RequestDebouncer debouncer(TransferSection{}, 0.1);
  for (const double doc : {0.0, 0.5, 0.49, 1.0, 0.2}) {
    EXPECT_EQ(Step(debouncer, doc), doc >= kThreshold ? 1 : 0);
  }
}

TEST(RequestDebouncerTest, BandLetsTheAutomationReturnOnlyBelowIt) {
  arbitrator::RequestDebouncer debouncer({.hysteresis = Hysteresis::kBand, .band = 0.2}, 0.1);
  EXPECT_EQ(Step(debouncer, 0.49), 0);
  EXPECT_EQ(Step(debouncer, 0.5), 1);
  EXPECT_EQ(Step(debouncer, 0.31), 1);
  EXPECT_EQ(Step(debouncer, 0.29), 0);
  EXPECT_EQ(Step(debouncer, 0.49), 0);
}

// L is the evidence that Wald's test adds up. With a DoC of 0.9 and a threshold of 0.5, L grows by
// ln 9 = 2.197 in a step. In the third step L exceeds Wald's upper bound ln 99 = 4.595.
TEST(RequestDebouncerTest, SprtWaitsForEnoughEvidenceInEitherDirection) {
  arbitrator::RequestDebouncer debouncer(
      {.hysteresis = Hysteresis::kSprt, .sprt_alpha = 0.01, .sprt_beta = 0.01}, 0.1);
  for (const double expected : {0.0, 0.0, 1.0, 1.0}) EXPECT_EQ(Step(debouncer, 0.9), expected);
  // After the decision Wald's test starts again, so the fourth step above left L = ln 9. Three
  // further steps, each of -ln 9, lead to L = -2 ln 9 = -4.39. This is above the lower bound
  // -ln 99 = -4.595, so a fourth step is needed.
  for (const double expected : {1.0, 1.0, 1.0, 0.0}) EXPECT_EQ(Step(debouncer, 0.1), expected);
}

TEST(RequestDebouncerTest, GoesOnFromAFirmRequest) {
  arbitrator::RequestDebouncer debouncer({.min_dwell_s = 1}, 0.1);
  EXPECT_EQ(Step(debouncer, 0.9), 1);
  EXPECT_EQ(debouncer.Step({.lambda_human = 0, .firm = true}, 0.9), 0);
  EXPECT_EQ(Step(debouncer, 0.1), 0) << "the human is not wanted any more";
  for (int i = 0; i < 8; ++i) EXPECT_EQ(Step(debouncer, 0.9), 0) << "step " << i;
  EXPECT_EQ(Step(debouncer, 0.9), 1) << "1 s after the firm request";
}

TEST(RequestDebouncerTest, SprtDecidesWithWaldsBounds) {
  arbitrator::RequestDebouncer eager(
      {.hysteresis = Hysteresis::kSprt, .sprt_alpha = 0.2, .sprt_beta = 0.01}, 0.1);
  EXPECT_EQ(Step(eager, 0.84), 1) << "ln(0.99/0.2) = 1.60 < logit(0.84) = 1.66";
  arbitrator::RequestDebouncer slow(
      {.hysteresis = Hysteresis::kSprt, .sprt_alpha = 0.2, .sprt_beta = 0.01}, 0.1);
  EXPECT_EQ(Step(slow, 0.82), 0) << "logit(0.82) = 1.52";
}

TEST(RequestDebouncerTest, SprtStaysFiniteWhereDocOrThresholdIsRoundedToOneOrNought) {
  arbitrator::RequestDebouncer debouncer({.hysteresis = Hysteresis::kSprt}, 0.1);
  EXPECT_EQ(debouncer.Step(policies::Compare(1, 1), 1), 0) << "no evidence either way";
  EXPECT_EQ(debouncer.Step(policies::Compare(1, 0), 1), 1);
  EXPECT_EQ(debouncer.Step(policies::Compare(0, 1), 0), 0);
}

TEST(RequestDebouncerTest, StaysAtLeastItsTime) {
  arbitrator::RequestDebouncer debouncer({.min_dwell_s = 0.3}, 0.1);
  EXPECT_EQ(Step(debouncer, 1), 1) << "nothing to wait for before the first transfer";
  EXPECT_EQ(Step(debouncer, 0), 1);
  EXPECT_EQ(Step(debouncer, 0), 1);
  EXPECT_EQ(Step(debouncer, 0), 0);
  EXPECT_EQ(Step(debouncer, 1), 0);
}

TEST(RequestDebouncerTest, TakesTheRequestOfTheMomentWhenTheStayIsOver) {
  arbitrator::RequestDebouncer debouncer({.min_dwell_s = 0.3}, 0.1);
  Step(debouncer, 1);
  Step(debouncer, 0);
  Step(debouncer, 0);
  EXPECT_EQ(Step(debouncer, 1), 1) << "the conflict is back";
}

TEST(RequestDebouncerTest, LetsAFirmRequestPass) {
  arbitrator::RequestDebouncer debouncer(
      {.hysteresis = Hysteresis::kBand, .band = 0.5, .min_dwell_s = 60}, 0.1);
  Step(debouncer, 1);
  EXPECT_EQ(debouncer.Step({.lambda_human = 0.25, .threshold = 0.5, .firm = true}, 1), 0.25);
}

double StepOf(arbitrator::RequestDebouncer& debouncer, double doc, bool recovered) {
  return debouncer.Step(policies::Compare(doc, kThreshold), doc, recovered);
}

TEST(RequestDebouncerTest, ReturnsToTheAutomationOnlyOnARecoveredTrack) {
  arbitrator::RequestDebouncer debouncer({.hand_back = HandBack::kFusion}, 0.1);
  EXPECT_EQ(StepOf(debouncer, 0, false), 0) << "it drives already";
  EXPECT_EQ(StepOf(debouncer, 1, true), 1) << "the way to the human does not wait";
  EXPECT_EQ(StepOf(debouncer, 0, false), 1);
  EXPECT_EQ(StepOf(debouncer, 0, true), 0);
  EXPECT_EQ(StepOf(debouncer, 0, false), 0) << "nothing is taken back";
}

TEST(RequestDebouncerTest, DoesNotAskForTheTrackByDefault) {
  arbitrator::RequestDebouncer plain(TransferSection{}, 0.1);
  arbitrator::RequestDebouncer banded({.hysteresis = Hysteresis::kBand}, 0.1);
  for (auto* debouncer : {&plain, &banded}) {
    EXPECT_EQ(StepOf(*debouncer, 1, false), 1);
    EXPECT_EQ(StepOf(*debouncer, 0, false), 0);
  }
}

TEST(RequestDebouncerTest, WaitsForTheTrackAfterEveryOtherDelay) {
  arbitrator::RequestDebouncer debouncer({.hysteresis = Hysteresis::kBand,
                                          .band = 0.2,
                                          .min_dwell_s = 0.3,
                                          .hand_back = HandBack::kFusion},
                                         0.1);
  EXPECT_EQ(StepOf(debouncer, 1, true), 1);
  EXPECT_EQ(StepOf(debouncer, 0.1, true), 1) << "the dwell";
  EXPECT_EQ(StepOf(debouncer, 0.4, true), 1) << "the band: the hysteresis has decided, but waits";
  EXPECT_EQ(StepOf(debouncer, 0.1, false), 1) << "the track";
  EXPECT_EQ(StepOf(debouncer, 0.1, true), 0);
}

TEST(RequestDebouncerTest, LetsAFirmRequestPassWhateverTheTrack) {
  arbitrator::RequestDebouncer debouncer({.hand_back = HandBack::kFusion}, 0.1);
  StepOf(debouncer, 1, false);
  EXPECT_EQ(debouncer.Step(policies::StayAutomated(kThreshold), 1, false), 0);
}

// The lower end of the band is at least half of the threshold. Otherwise no DoC could be below a
// wide band.
TEST(RequestDebouncerTest, ABandOfWhateverWidthGivesTheWheelBack) {
  for (const double threshold : {1e-6, 0.1, 0.2, 0.5, 1.0}) {
    for (const double band : {0.0, 0.2, 0.5, 1.0}) {
      arbitrator::RequestDebouncer debouncer({.hysteresis = Hysteresis::kBand, .band = band}, 0.1);
      const auto step = [&](double doc) {
        return debouncer.Step(policies::Compare(doc, threshold), doc);
      };
      EXPECT_EQ(step(threshold), 1);
      const double lower = threshold - std::min(band, threshold / 2);
      EXPECT_EQ(step(lower), 1) << threshold << ' ' << band;
      EXPECT_EQ(step(std::nextafter(lower, 0)), 0) << threshold << ' ' << band;
    }
  }
}

// A DoC that is a posterior probability contains the evidence of all steps, so the debouncer must
// not add it up. A posterior above 0.99 exceeds Wald's upper bound ln(0.99/0.01) = 4.595 in its
// first step; a posterior of 0.98 never does.
TEST(RequestDebouncerTest, SprtDoesNotCountTheEvidenceOfAPosteriorTwice) {
  arbitrator::RequestDebouncer debouncer(
      {.hysteresis = Hysteresis::kSprt, .sprt_alpha = 0.01, .sprt_beta = 0.01}, 0.1, true);
  for (int k = 0; k < 100; ++k) ASSERT_EQ(Step(debouncer, 0.98), 0);
  EXPECT_EQ(Step(debouncer, 0.991), 1);
  for (int k = 0; k < 100; ++k) ASSERT_EQ(Step(debouncer, 0.02), 1);
  EXPECT_EQ(Step(debouncer, 0.009), 0);
  EXPECT_EQ(debouncer.Step(policies::Compare(0.991, 0.9), 0.991), 0) << "against 0.9 it is less";
}

}  // namespace
}  // namespace fogline
