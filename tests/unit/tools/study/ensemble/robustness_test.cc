#include "tools/study/ensemble/robustness.h"

#include <array>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include "tools/study/claims.h"

namespace fogline {
namespace {

using study::InSet;
using study::JudgedInSet;
using study::Sign;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

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

/// A claim that certainly holds in each of `sets` sets of parameters.
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

/// A finding whose heading rests on one claim.
study::ExaminedFinding Finding(std::vector<study::KnownException> exceptions = {},
                               std::string_view why = "") {
  return {.number = 3,
          .name = "a gate",
          .heading = {.claims = {{.study = "policy", .says = kHelps}},
                      .exceptions = std::move(exceptions),
                      .why = why},
          .side = {}};
}

/// The claim that the heading of a finding has the verdicts that its author states (ClaimOnPart()).
study::Claim OnFinding(const study::ExaminedFinding& finding, const study::ClaimInSets& claim) {
  const auto all = std::span(&claim, 1);
  return study::ClaimOnPart(finding, study::Part::kHeading, all, study::JudgeInSets(all));
}

std::vector<InSet> VerdictsOf(const study::ClaimInSets& claim) {
  return study::VerdictsOn(study::JudgeInSets(std::span(&claim, 1)));
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
  // GIVEN a margin of 1, and differences far below -1, within the margin, far above 1, and at 1
  study::ClaimInSets claim{.quoted = {.study = "policy", .says = kCostsNothing}, .sets = {}};
  for (const double mean : {-3.0, 0.1, 3.0, 1.01}) {
    claim.sets.push_back(ClaimWith(mean, 0.2, Sign::kEqual, 1));
  }
  EXPECT_THAT(OutcomesOf(claim),
              ElementsAre(InSet::kOpposite, InSet::kHolds, InSet::kOpposite, InSet::kUndecided));
  // THEN a claim with kAbove also holds if the difference is far below -1, and a claim with kBelow
  // also holds if the difference is far above 1, or at 1
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
  // WHEN two claims both have this difference in two sets, so that there are four comparisons
  claim.sets.push_back(claim.sets[0]);
  const std::vector<study::ClaimInSets> two{claim, claim};
  const auto judged = study::JudgeInSets(two);
  // THEN Holm's method multiplies each p-value by four. The result is above 5 %, so no comparison
  // is decided
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

TEST(RobustnessTest, AHeadingThatHoldsInAllSetsSaysSo) {
  const study::ClaimInSets claim = InSets(8);
  const study::Claim on_all = OnFinding(Finding(), claim);
  EXPECT_EQ(on_all.says, "Finding 3, heading: holds in all eight parameter sets.");
  EXPECT_EQ(StateOf(on_all), report::ClaimState::kHolds);
  EXPECT_THAT(VerdictsOf(claim), Each(InSet::kHolds));
}

TEST(RobustnessTest, AHeadingThatFailsInOneSetIsNamedWithTheSet) {
  study::ClaimInSets claim = InSets(8);
  claim.sets[2] = ClaimWith(1, 0.1);
  EXPECT_EQ(VerdictsOf(claim)[2], InSet::kOpposite);
  // The finding does not list this exception, so the claim on the finding fails, and names claim,
  // set and outcome.
  const study::Claim surprise = OnFinding(Finding(), claim);
  EXPECT_EQ(surprise.hindrance, "set 3: \"It helps.\" is opposite");
  EXPECT_EQ(StateOf(surprise), report::ClaimState::kFails);
  EXPECT_EQ(StateOf(surprise, true), report::ClaimState::kOpen) << "with few runs";
  // The finding lists this exception, so the claim on the finding holds, and states the exception.
  const study::Claim known = OnFinding(Finding({{kHelps, {3}}}, "It does harm there."), claim);
  EXPECT_EQ(known.says,
            "Finding 3, heading: holds in sets 1, 2, 4, 5, 6, 7 and 8; opposite in set 3. It does "
            "harm there.");
  EXPECT_EQ(StateOf(known), report::ClaimState::kHolds);
}

TEST(RobustnessTest, AnExceptionThatTheRunsDoNotShowFails) {
  const study::Claim claim = OnFinding(Finding({{kHelps, {3, 5}}}, "It does harm."), InSets(8));
  EXPECT_EQ(claim.hindrance, "set 3: \"It helps.\" holds; set 5: \"It helps.\" holds");
  EXPECT_EQ(StateOf(claim), report::ClaimState::kFails);
}

TEST(RobustnessTest, AnUndecidedSetIsNotAnOppositeOne) {
  study::ClaimInSets claim = InSets(8);
  claim.sets[2] = ClaimWith(-0.1, 0.2);
  EXPECT_EQ(OnFinding(Finding({{kHelps, {3}}}, "It does harm."), claim).hindrance,
            "set 3: \"It helps.\" is undecided");
  const study::Claim known =
      OnFinding(Finding({{kHelps, {3}, InSet::kUndecided}}, "It is not certain."), claim);
  EXPECT_EQ(known.hindrance, "");
  EXPECT_THAT(known.says, HasSubstr("7 and 8; undecided in set 3. It is not certain."));
}

TEST(RobustnessTest, TheVerdictOnSeveralClaimsIsThatOfTheWorst) {
  const auto verdict = [](std::vector<InSet> claims) { return study::VerdictOn(claims); };
  EXPECT_EQ(verdict({InSet::kHolds, InSet::kHolds}), InSet::kHolds);
  EXPECT_EQ(verdict({InSet::kHolds, InSet::kUndecided}), InSet::kUndecided);
  EXPECT_EQ(verdict({InSet::kUndecided, InSet::kOpposite, InSet::kHolds}), InSet::kOpposite);
}

TEST(RobustnessTest, HeadingAndSideClaimsHaveVerdictsOfTheirOwn) {
  // GIVEN a heading that holds in all sets, and two side claims that do not
  study::ExaminedFinding finding = Finding();
  finding.side = {
      .claims = {{.study = "policy", .says = kHelps}, {.study = "policy", .says = kCostsNothing}},
      .exceptions = {{kHelps, {1}}, {kCostsNothing, {1, 2}, InSet::kUndecided}},
      .why = "It is so."};
  EXPECT_EQ(study::SentenceOf(finding, study::Part::kHeading, 3),
            "holds in all three parameter sets.");
  EXPECT_EQ(study::SentenceOf(finding, study::Part::kSide, 3),
            "hold in set 3; opposite in set 1; undecided in set 2. It is so.");
  // THEN the claim about the side claims holds if each side claim has the stated verdict in each
  // set, and fails if one of them has another verdict
  std::vector<study::ClaimInSets> claims{InSets(3), InSets(3, kCostsNothing)};
  claims[0].sets[0] = ClaimWith(1, 0.1);
  claims[1].sets[0] = claims[1].sets[1] = ClaimWith(-0.1, 0.2);
  const auto on_side = [&] {
    return study::ClaimOnPart(finding, study::Part::kSide, claims, study::JudgeInSets(claims));
  };
  EXPECT_EQ(StateOf(on_side()), report::ClaimState::kHolds);
  claims[1].sets[2] = ClaimWith(1, 0.1);
  EXPECT_EQ(on_side().hindrance, "set 3: \"It costs nothing.\" is opposite");
}

TEST(RobustnessTest, ShowsTheLeastCertainComparisonOfThoseThatAreDecided) {
  study::ClaimInSets claim = InSets(3);
  claim.sets[1] = ClaimWith(-0.5, 0.2);
  claim.sets[1].compared = "set 2: traded against none";
  const study::Claim on_finding = OnFinding(Finding(), claim);
  EXPECT_EQ(on_finding.difference.mean, -0.5);
  EXPECT_THAT(on_finding.compared,
              HasSubstr("of those that are decided: set 2: traded against none"));
}

TEST(RobustnessTest, CountsTheNumberOfComparisonsOnce) {
  study::ClaimInSets claim = InSets(2);
  claim.sets[0] = claim.sets[1] = ClaimWith(-1, 0.85);  // just sure enough for two comparisons
  const auto judged = study::JudgeInSets(std::span(&claim, 1));
  const study::Claim heading = OnFinding(Finding(), claim);
  EXPECT_EQ(heading.p_holm, judged[0][0].p_holm);
  for (const report::StudyClaim& one :
       study::CheckClaims(std::array{heading, heading, heading}, false)) {
    EXPECT_EQ(one.state, report::ClaimState::kHolds);
    EXPECT_THAT(one.found, HasSubstr(fmt::format("p = {:.3f}", judged[0][0].p_holm)));
  }
}

TEST(RobustnessTest, AClaimThatIsOppositeInAllSetsIsShownTurnedAround) {
  study::ClaimInSets claim = InSets(2);
  claim.sets[0] = claim.sets[1] = ClaimWith(1, 0.1);
  study::Claim on_finding = OnFinding(Finding({{kHelps, {1, 2}}}, "It does harm."), claim);
  EXPECT_EQ(on_finding.says,
            "Finding 3, heading: opposite in all two parameter sets. It does harm.");
  EXPECT_EQ(on_finding.sign, Sign::kMore);
  EXPECT_EQ(StateOf(on_finding), report::ClaimState::kHolds);
  // A claim of equality with a margin of 1 is opposite, because its difference is 3. So the claim
  // on the finding says by how much the difference is above the margin: by 2.
  claim = InSets(2, kCostsNothing);
  claim.sets[0] = claim.sets[1] = ClaimWith(3, 0.1, Sign::kEqual, 1);
  study::ExaminedFinding finding = Finding({{kCostsNothing, {1, 2}}}, "It costs something.");
  finding.heading.claims.front().says = kCostsNothing;
  on_finding = OnFinding(finding, claim);
  EXPECT_EQ(on_finding.sign, Sign::kMore);
  EXPECT_DOUBLE_EQ(on_finding.difference.mean, 2);
  EXPECT_EQ(StateOf(on_finding), report::ClaimState::kHolds);
}

TEST(RobustnessTest, AClaimOnOneSideOfItsMarginIsCheckedOnThatSide) {
  // GIVEN a claim of equality with a margin of 1 that needs only its upper bound (kAbove), and a
  // difference of -1.2 in set 2, which is below the lower bound of -1
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

TEST(RobustnessTest, NamesItsSets) {
  EXPECT_EQ(study::SetsText(std::array{2}, 8), "set 2");
  EXPECT_EQ(study::SetsText(std::array{1, 3}, 8), "sets 1 and 3");
  EXPECT_EQ(study::SetsText(std::array{2, 5, 7}, 8), "sets 2, 5 and 7");
  EXPECT_EQ(study::SetsText(std::array{1, 2, 3}, 3), "all three parameter sets");
}

}  // namespace
}  // namespace fogline
