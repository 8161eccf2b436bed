#include "tools/study/ensemble/robustness.h"

#include <array>
#include <string>
#include <vector>

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include "tools/study/claims.h"

namespace fogline {
namespace {

using study::InSet;
using study::JudgedInSet;
using study::Sign;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::string_view kHelps = "It helps.";
constexpr std::string_view kCostsNothing = "It costs nothing.";

/// A claim whose difference has this mean, and an interval of this half width.
study::Claim ClaimWith(double mean, double half, Sign sign = Sign::kLess, double margin = 0) {
  return {.says = "",
          .compared = "traded against none",
          .sign = sign,
          .difference = {.n = 100,
                         .mean = mean,
                         .deviation = 5 * half,
                         .low = mean - half,
                         .high = mean + half},
          .margin = margin,
          .p = {},
          .hindrance = {}};
}

/// A claim with so many sets, in each of which it holds beyond doubt.
study::ClaimInSets InSets(std::size_t sets, std::string_view says = kHelps) {
  return {.quoted = {.study = "policy", .says = says},
          .sets = std::vector<study::Claim>(sets, ClaimWith(-1, 0.1))};
}

std::vector<InSet> OutcomesOf(const study::ClaimInSets& claim) {
  std::vector<InSet> outcomes;
  const auto judged = study::JudgeInSets(std::span(&claim, 1));
  for (const JudgedInSet& one : judged.front()) outcomes.push_back(one.outcome);
  return outcomes;
}

study::ExaminedFinding Finding(std::vector<study::KnownException> exceptions = {},
                               std::string_view why = "") {
  return {.number = 3,
          .name = "a gate",
          .central = {{.study = "policy", .says = kHelps}},
          .exceptions = std::move(exceptions),
          .why = why};
}

/// The claim on a finding that rests on this claim alone.
study::Claim OnFinding(const study::ExaminedFinding& finding, const study::ClaimInSets& claim) {
  const auto all = std::span(&claim, 1);
  return study::ClaimOnFinding(finding, all, study::JudgeInSets(all));
}

report::ClaimState StateOf(const study::Claim& claim, bool few_runs = false) {
  return study::CheckClaims(std::array{claim}, few_runs).front().state;
}

TEST(RobustnessTest, SaysOfEachSetWhetherTheDifferenceHasTheSign) {
  study::ClaimInSets claim = InSets(3);
  claim.sets[1] = ClaimWith(1, 0.1);
  claim.sets[2] = ClaimWith(-0.1, 0.2);
  EXPECT_THAT(OutcomesOf(claim), ElementsAre(InSet::kHolds, InSet::kOpposite, InSet::kUndecided));
  for (study::Claim& one : claim.sets) one.sign = Sign::kMore;
  EXPECT_THAT(OutcomesOf(claim), ElementsAre(InSet::kOpposite, InSet::kHolds, InSet::kUndecided));
}

TEST(RobustnessTest, EqualityHoldsWithinItsMarginOrOnOneSideOfIt) {
  // GIVEN differences far below, just inside, and far above a margin of 1, and one at the margin
  study::ClaimInSets claim{.quoted = {.study = "policy", .says = kCostsNothing}, .sets = {}};
  for (const double mean : {-3.0, 0.1, 3.0, 1.01}) {
    claim.sets.push_back(ClaimWith(mean, 0.2, Sign::kEqual, 1));
  }
  EXPECT_THAT(OutcomesOf(claim),
              ElementsAre(InSet::kOpposite, InSet::kHolds, InSet::kOpposite, InSet::kUndecided));
  // THEN a rule that costs nothing may save something, and the other way round
  claim.quoted.bound = study::Bound::kAbove;
  EXPECT_THAT(OutcomesOf(claim),
              ElementsAre(InSet::kHolds, InSet::kHolds, InSet::kOpposite, InSet::kUndecided));
  claim.quoted.bound = study::Bound::kBelow;
  EXPECT_THAT(OutcomesOf(claim),
              ElementsAre(InSet::kOpposite, InSet::kHolds, InSet::kHolds, InSet::kHolds));
}

TEST(RobustnessTest, WhatIsNotComparableIsUndecided) {
  study::ClaimInSets claim = InSets(2);
  claim.sets[0].hindrance = "not comparable: runs end early";
  claim.sets[1].difference = {.n = 1, .mean = -1};
  EXPECT_THAT(OutcomesOf(claim), ElementsAre(InSet::kUndecided, InSet::kUndecided));
}

TEST(RobustnessTest, HolmCountsAllClaimsInAllSets) {
  // GIVEN a difference that is 2.5 standard errors below 0: p = 0.014
  study::ClaimInSets claim = InSets(1);
  claim.sets[0] = ClaimWith(-1, 1 * 1.984 / 2.5);
  EXPECT_THAT(OutcomesOf(claim), ElementsAre(InSet::kHolds));
  // WHEN it is one of four comparisons of two claims in two sets, all equally uncertain
  claim.sets.push_back(claim.sets[0]);
  const std::vector<study::ClaimInSets> two{claim, claim};
  const auto judged = study::JudgeInSets(two);
  // THEN four times its p-value is above 5 %
  ASSERT_EQ(judged.size(), 2U);
  for (const auto& sets : judged) {
    ASSERT_EQ(sets.size(), 2U);
    for (const JudgedInSet& one : sets) {
      EXPECT_LT(one.p, 0.05);
      EXPECT_NEAR(one.p_holm, 4 * one.p, 1e-12);
      EXPECT_EQ(one.outcome, InSet::kUndecided);
    }
  }
}

TEST(RobustnessTest, AFindingIsRobustOnlyIfItHoldsInAllSets) {
  const study::ClaimInSets claim = InSets(8);
  const study::Claim on_all = OnFinding(Finding(), claim);
  EXPECT_EQ(on_all.says, "Finding 3 holds in all eight parameter sets.");
  EXPECT_EQ(StateOf(on_all), report::ClaimState::kHolds);
  EXPECT_THAT(study::SetsWithout(study::JudgeInSets(std::span(&claim, 1))), IsEmpty());
}

TEST(RobustnessTest, AFindingThatFailsInOneSetIsNamedWithTheSet) {
  study::ClaimInSets claim = InSets(8);
  claim.sets[2] = ClaimWith(1, 0.1);
  EXPECT_THAT(study::SetsWithout(study::JudgeInSets(std::span(&claim, 1))), ElementsAre(3));
  // Nobody expects it: the study is red, and names claim, set and outcome.
  const study::Claim surprise = OnFinding(Finding(), claim);
  EXPECT_EQ(surprise.hindrance, "set 3: \"It helps.\" is opposite");
  EXPECT_EQ(StateOf(surprise), report::ClaimState::kFails);
  EXPECT_EQ(StateOf(surprise, true), report::ClaimState::kOpen) << "with few runs";
  // The author knows it: the claim says what was found.
  const study::Claim known = OnFinding(Finding({{kHelps, {3}}}, "it does harm there."), claim);
  EXPECT_EQ(known.says, "Finding 3 does not hold in set 3: it does harm there.");
  EXPECT_EQ(StateOf(known), report::ClaimState::kHolds);
}

TEST(RobustnessTest, AnExceptionThatTheRunsDoNotShowFails) {
  const study::Claim claim = OnFinding(Finding({{kHelps, {3, 5}}}, "it does harm."), InSets(8));
  EXPECT_EQ(claim.hindrance, "set 3: \"It helps.\" holds; set 5: \"It helps.\" holds");
  EXPECT_EQ(StateOf(claim), report::ClaimState::kFails);
}

TEST(RobustnessTest, AnUndecidedSetIsNotAnOppositeOne) {
  study::ClaimInSets claim = InSets(8);
  claim.sets[2] = ClaimWith(-0.1, 0.2);
  EXPECT_EQ(OnFinding(Finding({{kHelps, {3}}}, "it does harm."), claim).hindrance,
            "set 3: \"It helps.\" is undecided");
  EXPECT_EQ(
      OnFinding(Finding({{kHelps, {3}, InSet::kUndecided}}, "it is not certain."), claim).hindrance,
      "");
}

TEST(RobustnessTest, ShowsTheLeastCertainComparisonOfThoseThatHold) {
  study::ClaimInSets claim = InSets(3);
  claim.sets[1] = ClaimWith(-0.5, 0.2);
  claim.sets[1].compared = "set 2: traded against none";
  const study::Claim on_finding = OnFinding(Finding(), claim);
  EXPECT_EQ(on_finding.difference.mean, -0.5);
  EXPECT_THAT(on_finding.compared, HasSubstr("of those that hold: set 2: traded against none"));
}

TEST(RobustnessTest, AClaimOnOneSideOfItsMarginIsCheckedOnThatSide) {
  // GIVEN a rule that costs nothing, and in one set saves more than the margin
  study::ClaimInSets claim = InSets(2, kCostsNothing);
  claim.quoted.bound = study::Bound::kAbove;
  claim.sets[0] = ClaimWith(-0.2, 0.1, Sign::kEqual, 1);
  claim.sets[1] = ClaimWith(-1.2, 0.8, Sign::kEqual, 1);
  const study::Claim on_finding = OnFinding(Finding(), claim);
  EXPECT_EQ(on_finding.sign, Sign::kLess);
  EXPECT_DOUBLE_EQ(on_finding.difference.mean, -2.2);
  EXPECT_THAT(on_finding.compared, HasSubstr("traded against none, difference from 1"));
  EXPECT_EQ(StateOf(on_finding), report::ClaimState::kHolds);
}

TEST(RobustnessTest, SaysItsSentence) {
  EXPECT_EQ(study::SentenceOf(Finding(), 8), "Holds in all eight parameter sets.");
  const auto with = [](std::vector<int> sets) {
    return study::SentenceOf(Finding({{kHelps, std::move(sets)}}, "it does harm."), 3);
  };
  EXPECT_EQ(with({2}), "Does not hold in set 2: it does harm.");
  EXPECT_EQ(with({1, 3}), "Does not hold in sets 1 and 3: it does harm.");
  EXPECT_EQ(with({1, 2, 3}), "Holds in none of the three parameter sets: it does harm.");
  EXPECT_EQ(study::SetsText(std::array{2, 5, 7}), "sets 2, 5 and 7");
}

}  // namespace
}  // namespace fogline
