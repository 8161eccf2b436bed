// Makes claims (claim.h) from comparisons, and checks the claims against the numbers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/report/study_page.h"
#include "tools/study/claim.h"
#include "tools/study/comparison.h"
#include "tools/study/estimate.h"

namespace fogline::study {

/// A difference of compromised safety that is too small to matter, m. The value is our choice. In
/// paper.json without traded control, the mean compromised safety in fog is 0.015 m, about eight
/// times as much. A driver notices only far larger differences.
inline constexpr double kNoShortfall_m = 0.002;

/// The names of a case and of a variant.
struct CellName {
  CellName(std::string_view in_case, std::string_view of_variant)
      : test_case(in_case), variant(of_variant) {}

  std::string test_case;
  std::string variant;
};

/// @throws std::out_of_range if there is no such case or variant
Cell CellOf(const Comparison& comparison, const CellName& name);

/// The plan of a claim, before its runs: the text, the measure, and the cells or the level that the
/// claim compares.
struct PlannedClaim {
  std::string says;
  CellName cell;
  std::optional<CellName> other;  // compared with `cell`; nullopt: `level` is compared with `cell`
  std::string measure;
  Sign sign = Sign::kLess;
  double margin = 0;  // for kEqual, in the unit of the measure
  double level = 0;   // in the unit of the measure; used if `other` is nullopt
};

/// The claim that the mean of a difference has this sign. The difference is the measure in cell `a`
/// minus the measure in cell `b`.
PlannedClaim PairClaim(std::string says, CellName a, CellName b, std::string_view measure,
                       Sign sign, double margin = 0);
/// The claim that the mean of a measure, minus `level`, has this sign.
PlannedClaim LevelClaim(std::string says, CellName cell, std::string_view measure, Sign sign,
                        double level);

/// Computes a claim from the runs, paired seed by seed. For the measure "collided" in two cells,
/// the p-value comes from McNemar's exact test (1947). For any other measure in two cells, the
/// claim has a hindrance (Claim::hindrance) if a run of a pair ends early
/// (Comparison::PairsCutShort()): then sums and means over time lack the steps after the end.
/// @throws std::out_of_range if there is no such case, variant or measure
Claim ClaimOf(const Comparison& comparison, const PlannedClaim& planned);
std::vector<Claim> ClaimsOf(const Comparison& comparison, std::span<const PlannedClaim> planned);

/// p-value of the claim, not adjusted; 1 if the claim has a hindrance (Claim::hindrance).
double PValueOf(const Claim& claim);

/// Checks the claims of one study together. A claim holds if the difference has the claimed sign,
/// and if the claim's p-value, adjusted by Holm's method, is below 5 %. If Claim::p_holm is set, it
/// is this adjusted p-value. A claim with a hindrance (Claim::hindrance) does not hold. A claim
/// that does not hold fails, or stays open if `few_runs` is true (fewer seeds than the study's
/// default).
std::vector<report::StudyClaim> CheckClaims(std::span<const Claim> claims, bool few_runs);

/// "study policy: 2 of 9 claims fail:", then a line for each failed claim; "" if no claim fails.
std::string FailedText(std::string_view study, std::span<const report::StudyClaim> claims);

}  // namespace fogline::study
