#include "tools/study/claims.h"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tools/study/examples.h"

namespace fogline {
namespace {

using ::testing::HasSubstr;

constexpr double kWholeRun = 500;  // steps
constexpr std::string_view kShortfall = "mean_compromised_safety_fog_m";

/// A comparison of `none` and `traded` in one case. The runs are equal except for the values that a
/// test sets.
class Runs {
 public:
  Runs() {
    values_.assign(2 * study::ComparedMetrics().size() * kSeeds, 0.0);
    for (const std::size_t variant : {0U, 1U}) {
      Set(variant, "steps", [](std::int64_t) { return kWholeRun; });
    }
  }

  template <class ValueOf>
  void Set(std::size_t variant, std::string_view measure, ValueOf value_of) {
    const std::size_t row =
        variant * study::ComparedMetrics().size() + study::PlaceOfMetric(measure);
    for (std::int64_t i = 0; i < kSeeds; ++i) {
      values_[row * kSeeds + static_cast<std::size_t>(i)] = value_of(i);
    }
  }
  /// Sets the mean compromised safety in fog, a little different for each seed.
  void Compromise(std::size_t variant, double mean_m) {
    Set(variant, kShortfall,
        [&](std::int64_t seed) { return mean_m + 0.001 * static_cast<double>(seed % 3) * mean_m; });
  }
  void Crash(std::size_t variant, std::int64_t runs) {
    Set(variant, "collided", [&](std::int64_t seed) { return seed < runs ? 1.0 : 0.0; });
    Set(variant, "steps", [&](std::int64_t seed) { return seed < runs ? 100.0 : kWholeRun; });
  }

  study::Claim ClaimThat(study::Sign sign, std::string_view measure = kShortfall,
                         double margin = 0) const {
    const study::Comparison comparison({{"fog", "paper.json", {}}}, {{"none", {}}, {"traded", {}}},
                                       kSeeds, values_);
    return study::ClaimOf(comparison, study::PairClaim("It helps.", {"fog", "traded"},
                                                       {"fog", "none"}, measure, sign, margin));
  }

 private:
  std::vector<double> values_;
};

report::StudyClaim CheckOne(const study::Claim& claim, bool few_runs = false) {
  return study::CheckClaims(std::array{claim}, few_runs).front();
}

TEST(ClaimsTest, AClaimHoldsByItsSignAndFailsWhenItIsTurnedAround) {
  Runs runs;
  runs.Compromise(0, 0.04);
  runs.Compromise(1, 0.01);
  const report::StudyClaim right = CheckOne(runs.ClaimThat(study::Sign::kLess));
  EXPECT_EQ(right.state, report::ClaimState::kHolds);
  EXPECT_EQ(right.compared, "fog: traded against none, mean compromised safety in fog (m)");
  EXPECT_EQ(right.expected, "less");
  EXPECT_THAT(right.found, HasSubstr("p < 0.001"));
  EXPECT_EQ(CheckOne(runs.ClaimThat(study::Sign::kMore)).state, report::ClaimState::kFails);
  EXPECT_EQ(CheckOne(runs.ClaimThat(study::Sign::kMore), true).state, report::ClaimState::kOpen);
}

TEST(ClaimsTest, EqualMeansCloserThanTheMargin) {
  Runs runs;
  runs.Compromise(0, 0.04);
  runs.Compromise(1, 0.0405);
  EXPECT_EQ(CheckOne(runs.ClaimThat(study::Sign::kEqual, kShortfall, 0.001)).state,
            report::ClaimState::kHolds);
  EXPECT_EQ(CheckOne(runs.ClaimThat(study::Sign::kEqual, kShortfall, 0.0004)).state,
            report::ClaimState::kFails);
  // Equal runs are equal within any margin above 0.
  runs.Compromise(1, 0.04);
  EXPECT_EQ(CheckOne(runs.ClaimThat(study::Sign::kEqual, kShortfall, 1e-9)).state,
            report::ClaimState::kHolds);
  EXPECT_EQ(CheckOne(runs.ClaimThat(study::Sign::kLess)).state, report::ClaimState::kFails);
}

TEST(ClaimsTest, WhatTheRunsDoNotDecideFailsAndIsOpenWithFewRuns) {
  Runs runs;
  runs.Set(0, kShortfall, [](std::int64_t seed) { return seed % 2 == 0 ? 0.01 : 0.03; });
  runs.Set(1, kShortfall, [](std::int64_t seed) { return seed % 2 == 0 ? 0.0299 : 0.01; });
  const study::Claim claim = runs.ClaimThat(study::Sign::kLess);
  EXPECT_EQ(CheckOne(claim).state, report::ClaimState::kFails);
  EXPECT_EQ(CheckOne(claim, true).state, report::ClaimState::kOpen);
}

TEST(ClaimsTest, CollisionsAreComparedByTheExactTestOfMcNemar) {
  Runs runs;
  runs.Crash(1, 5);
  // p is 2 * 0.5^5 with five pairs, and 2 * 0.5^6 with six pairs.
  EXPECT_DOUBLE_EQ(study::PValueOf(runs.ClaimThat(study::Sign::kMore, "collided")), 0.0625);
  runs.Crash(1, 6);
  const study::Claim more = runs.ClaimThat(study::Sign::kMore, "collided");
  EXPECT_DOUBLE_EQ(study::PValueOf(more), 0.03125);
  EXPECT_EQ(CheckOne(more).state, report::ClaimState::kHolds);
  EXPECT_EQ(CheckOne(runs.ClaimThat(study::Sign::kLess, "collided")).state,
            report::ClaimState::kFails);
}

TEST(ClaimsTest, RunsThatEndEarlyProveNothingAboutOtherMeasures) {
  Runs runs;
  runs.Compromise(0, 0.04);
  runs.Compromise(1, 0.01);
  runs.Crash(1, 3);
  const report::StudyClaim claim = CheckOne(runs.ClaimThat(study::Sign::kLess));
  EXPECT_EQ(claim.state, report::ClaimState::kFails);
  EXPECT_EQ(CheckOne(runs.ClaimThat(study::Sign::kLess), true).state, report::ClaimState::kOpen);
  EXPECT_EQ(claim.found, "not comparable: the runs of 3 of 20 seeds end early");
}

TEST(ClaimsTest, ALevelIsComparedWithTheMean) {
  const study::Comparison comparison({{"fog", "paper.json", {}}}, {{"none", {}}}, 2,
                                     std::vector<double>(study::ComparedMetrics().size() * 2, 3));
  const study::Claim claim =
      study::ClaimOf(comparison, study::LevelClaim("It is more.", {"fog", "none"},
                                                   "max_abs_jerk_mps3", study::Sign::kMore, 2.5));
  EXPECT_DOUBLE_EQ(claim.difference.mean, 0.5);
  EXPECT_EQ(claim.compared, "fog: none against 2.5, largest jerk (m/s3)");
  EXPECT_EQ(CheckOne(claim).state, report::ClaimState::kHolds);
}

TEST(ClaimsTest, ANameThatIsNotThereIsRefused) {
  const study::Comparison comparison({{"fog", "paper.json", {}}}, {{"none", {}}}, 1,
                                     std::vector<double>(study::ComparedMetrics().size(), 0));
  const auto claim = [&](const study::CellName& cell, std::string_view measure) {
    return study::ClaimOf(comparison,
                          study::PairClaim("", cell, {"fog", "none"}, measure, study::Sign::kLess));
  };
  EXPECT_THROW(claim({"mist", "none"}, "steps"), std::out_of_range);
  EXPECT_THROW(claim({"fog", "traded"}, "steps"), std::out_of_range);
  EXPECT_THROW(claim({"fog", "none"}, "beauty"), std::out_of_range);
}

TEST(ClaimsTest, ManyClaimsNeedMoreEvidenceThanOne) {
  Runs runs;
  runs.Crash(1, 6);  // p = 0.031
  const study::Claim claim = runs.ClaimThat(study::Sign::kMore, "collided");
  const std::vector<report::StudyClaim> two = study::CheckClaims(std::array{claim, claim}, false);
  EXPECT_EQ(two[0].state, report::ClaimState::kFails);
  EXPECT_EQ(study::FailedText("policy", two).substr(0, 36),
            "study policy: 2 of 2 claims fail:\n  ");
  EXPECT_EQ(study::FailedText("policy", std::array{CheckOne(claim)}), "");
}

}  // namespace
}  // namespace fogline
