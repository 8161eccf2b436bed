#include "tools/study/claims.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include "tools/stats/holm.h"

namespace fogline::study {
namespace {

constexpr double kLevel = 0.05;

std::string NameWithUnit(std::string_view measure) {
  const ComparedMetric& info = ComparedMetrics()[PlaceOfMetric(measure)];
  return info.unit.empty() ? NameForReaders(measure)
                           : fmt::format("{} ({})", NameForReaders(measure), info.unit);
}

bool HasSign(const Claim& claim) {
  const double mean = claim.difference.mean;
  switch (claim.sign) {
    case Sign::kLess:
      return mean < 0;
    case Sign::kMore:
      return mean > 0;
    case Sign::kEqual:
      return std::abs(mean) <= claim.margin;
  }
  return false;
}

std::string_view ExpectedText(Sign sign) {
  switch (sign) {
    case Sign::kLess:
      return "less";
    case Sign::kMore:
      return "more";
    case Sign::kEqual:
      return "equal";
  }
  return "";
}

std::string FoundText(const Claim& claim, double p) {
  if (!claim.hindrance.empty()) return claim.hindrance;
  if (!claim.difference.has_interval()) return "too few runs for an interval";
  constexpr double kSmallest = 0.001;
  return fmt::format("{}, p {}", Text(claim.difference),
                     p < kSmallest ? "< 0.001" : fmt::format("= {:.3f}", p));
}

report::ClaimState StateOf(const Claim& claim, double p, bool few_runs) {
  if (claim.hindrance.empty() && HasSign(claim) && p < kLevel) return report::ClaimState::kHolds;
  return few_runs ? report::ClaimState::kOpen : report::ClaimState::kFails;
}

Claim OfPair(const Comparison& comparison, const PlannedClaim& planned, const CellName& b) {
  const CellName& a = planned.cell;
  const Cell cell_a = CellOf(comparison, a);
  const Cell cell_b = CellOf(comparison, b);
  const bool one_case = a.test_case == b.test_case;
  const std::string measure = NameWithUnit(planned.measure);
  Claim claim{.says = planned.says,
              .compared = one_case ? fmt::format("{}: {} against {}, {}", a.test_case, a.variant,
                                                 b.variant, measure)
                                   : fmt::format("{}: {} against {}, {}", a.variant, a.test_case,
                                                 b.test_case, measure),
              .sign = planned.sign,
              .difference = comparison.Difference(cell_a, cell_b, planned.measure),
              .margin = planned.margin,
              .p = {},
              .hindrance = {}};
  if (planned.measure == kCollided) {
    claim.p = comparison.PValueOfCollisions(cell_a, cell_b);
  } else if (const std::int64_t cut_short = comparison.PairsCutShort(cell_a, cell_b);
             cut_short > 0) {
    claim.hindrance = fmt::format("not comparable: the runs of {} of {} seeds end early", cut_short,
                                  comparison.seeds());
  }
  return claim;
}

Claim OfLevel(const Comparison& comparison, const PlannedClaim& planned) {
  Estimate difference = comparison.Mean(CellOf(comparison, planned.cell), planned.measure);
  for (double* value : {&difference.mean, &difference.low, &difference.high}) {
    *value -= planned.level;
  }
  return {
      .says = planned.says,
      .compared = fmt::format("{}: {} against {:g}, {}", planned.cell.test_case,
                              planned.cell.variant, planned.level, NameWithUnit(planned.measure)),
      .sign = planned.sign,
      .difference = difference,
      .margin = planned.margin,
      .p = {},
      .hindrance = {}};
}

}  // namespace

Cell CellOf(const Comparison& comparison, const CellName& name) {
  return {comparison.CaseNamed(name.test_case), comparison.VariantNamed(name.variant)};
}

PlannedClaim PairClaim(std::string says, CellName a, CellName b, std::string_view measure,
                       Sign sign, double margin) {
  return {.says = std::move(says),
          .cell = std::move(a),
          .other = std::move(b),
          .measure = std::string(measure),
          .sign = sign,
          .margin = margin};
}

PlannedClaim LevelClaim(std::string says, CellName cell, std::string_view measure, Sign sign,
                        double level) {
  return {.says = std::move(says),
          .cell = std::move(cell),
          .other = {},
          .measure = std::string(measure),
          .sign = sign,
          .level = level};
}

Claim ClaimOf(const Comparison& comparison, const PlannedClaim& planned) {
  return planned.other ? OfPair(comparison, planned, *planned.other) : OfLevel(comparison, planned);
}

std::vector<Claim> ClaimsOf(const Comparison& comparison, std::span<const PlannedClaim> planned) {
  std::vector<Claim> claims;
  for (const PlannedClaim& one : planned) claims.push_back(ClaimOf(comparison, one));
  return claims;
}

double PValueOf(const Claim& claim) {
  if (!claim.hindrance.empty()) return 1;
  if (claim.sign == Sign::kEqual) return PValueOfEqual(claim.difference, claim.margin);
  return claim.p.value_or(PValueOfSign(claim.difference));
}

std::vector<report::StudyClaim> CheckClaims(std::span<const Claim> claims, bool few_runs) {
  std::vector<double> p;
  for (const Claim& claim : claims) {
    if (!claim.p_holm) p.push_back(PValueOf(claim));
  }
  const std::vector<double> adjusted = stats::Holm(p);
  std::vector<report::StudyClaim> checked;
  std::size_t next = 0;
  for (const Claim& claim : claims) {
    const double p_holm = claim.p_holm ? *claim.p_holm : adjusted[next++];
    const std::string margin =
        claim.sign == Sign::kEqual ? fmt::format(" (within {:g})", claim.margin) : "";
    checked.push_back({.says = claim.says,
                       .compared = claim.compared,
                       .expected = fmt::format("{}{}", ExpectedText(claim.sign), margin),
                       .found = FoundText(claim, p_holm),
                       .state = StateOf(claim, p_holm, few_runs)});
  }
  return checked;
}

std::string FailedText(std::string_view study, std::span<const report::StudyClaim> claims) {
  const auto failed =
      std::ranges::count(claims, report::ClaimState::kFails, &report::StudyClaim::state);
  if (failed == 0) return "";
  std::string text = fmt::format("study {}: {} of {} claims fail:", study, failed, claims.size());
  for (const report::StudyClaim& claim : claims) {
    if (claim.state != report::ClaimState::kFails) continue;
    text += fmt::format("\n  {} (expected {}: {}; found {})", claim.says, claim.expected,
                        claim.compared, claim.found);
  }
  return text;
}

}  // namespace fogline::study
