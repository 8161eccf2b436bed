// Turns each claim of the studies around, computes the study with real runs, and expects that the
// turned claim fails.
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tools/study/claims.h"
#include "tools/study/comparison.h"
#include "tools/study/design.h"
#include "tools/study/study.h"

namespace fogline::test {
namespace {

using report::ClaimState;
using study::Sign;
using ::testing::HasSubstr;

study::StudyContext Context() {
  return {.scenarios = SourceDirectory() / "scenario", .seeds = {1, 4}, .jobs = 2, .progress = {}};
}

study::Claim Turned(study::Claim claim) {
  claim.sign = claim.sign == Sign::kLess ? Sign::kMore : Sign::kLess;
  return claim;
}

// The check of a claim, as in a study with all seeds: a claim that does not hold fails.
report::StudyClaim Checked(const study::Claim& claim) {
  return study::CheckClaims(std::array{claim}, false).front();
}

template <class Named>
void KeepNamed(const std::set<std::string>& names, std::vector<Named>& all) {
  std::erase_if(all, [&](const Named& one) { return !names.contains(one.name); });
}

/// The runs of all cases with all variants that the claims of a study compare.
study::Comparison RunClaims(study::StudyDesign design) {
  std::set<std::string> cases;
  std::set<std::string> variants;
  for (const study::PlannedClaim& claim : design.claims) {
    for (const study::CellName& cell : {claim.cell, claim.other.value_or(claim.cell)}) {
      cases.insert(cell.test_case);
      variants.insert(cell.variant);
    }
  }
  KeepNamed(cases, design.cases);
  KeepNamed(variants, design.variants);
  return {Context(), std::move(design.cases), std::move(design.variants)};
}

void ExpectThatTurnedClaimsFail(const char* name, const study::StudyDesign& design) {
  const study::Comparison comparison = RunClaims(design);
  int certain = 0;
  for (const study::Claim& claim : study::ClaimsOf(comparison, design.claims)) {
    if (claim.sign == Sign::kEqual) continue;
    const report::StudyClaim turned = Checked(Turned(claim));
    EXPECT_EQ(turned.state, ClaimState::kFails) << name << ": " << claim.says;
    EXPECT_THAT(study::FailedText(name, std::array{turned}), HasSubstr(claim.says));
    if (Checked(claim).state == ClaimState::kHolds) ++certain;
  }
  EXPECT_GE(certain, 3) << name;
}

TEST(TurnedClaimsTest, EveryClaimOnADifferenceFailsWhenItIsTurnedAround) {
  const Scenario paper = Context().Load("paper.json", {});
  ExpectThatTurnedClaimsFail("policy", study::PolicyDesign(paper));
  ExpectThatTurnedClaimsFail("takeover", study::TakeOverDesign());
  ExpectThatTurnedClaimsFail("transfer", study::TransferDesign());
  ExpectThatTurnedClaimsFail("driver", study::DriverDesign());
  ExpectThatTurnedClaimsFail("followers", study::FollowersDesign());
  ExpectThatTurnedClaimsFail("vehicle", study::VehicleDesign());
}

}  // namespace
}  // namespace fogline::test
