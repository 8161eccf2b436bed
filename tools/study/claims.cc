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

}  // namespace

Claim ClaimOf(const Comparison& comparison, std::string says, CellName a, CellName b,
              std::string_view measure, Sign sign, double margin) {
  const Cell cell_a{comparison.CaseNamed(a.test_case), comparison.VariantNamed(a.variant)};
  const Cell cell_b{comparison.CaseNamed(b.test_case), comparison.VariantNamed(b.variant)};
  const bool one_case = a.test_case == b.test_case;
  Claim claim{.says = std::move(says),
              .compared = one_case ? fmt::format("{}: {} against {}, {}", a.test_case, a.variant,
                                                 b.variant, NameWithUnit(measure))
                                   : fmt::format("{}: {} against {}, {}", a.variant, a.test_case,
                                                 b.test_case, NameWithUnit(measure)),
              .sign = sign,
              .difference = comparison.Difference(cell_a, cell_b, measure),
              .margin = margin,
              .p = {},
              .hindrance = {}};
  if (measure == kCollided) {
    claim.p = comparison.PValueOfCollisions(cell_a, cell_b);
  } else if (const std::int64_t cut_short = comparison.PairsCutShort(cell_a, cell_b);
             cut_short > 0) {
    claim.hindrance = fmt::format("not comparable: the runs of {} of {} seeds end early", cut_short,
                                  comparison.seeds());
  }
  return claim;
}

Claim LevelClaim(const Comparison& comparison, std::string says, CellName cell,
                 std::string_view measure, Sign sign, double level, double margin) {
  Estimate difference = comparison.Mean(
      {comparison.CaseNamed(cell.test_case), comparison.VariantNamed(cell.variant)}, measure);
  for (double* value : {&difference.mean, &difference.low, &difference.high}) *value -= level;
  return {.says = std::move(says),
          .compared = fmt::format("{}: {} against {:g}, {}", cell.test_case, cell.variant, level,
                                  NameWithUnit(measure)),
          .sign = sign,
          .difference = difference,
          .margin = margin,
          .p = {},
          .hindrance = {}};
}

double PValueOf(const Claim& claim) {
  if (!claim.hindrance.empty()) return 1;
  if (claim.sign == Sign::kEqual) return PValueOfEqual(claim.difference, claim.margin);
  return claim.p.value_or(PValueOfSign(claim.difference));
}

std::vector<report::StudyClaim> CheckClaims(std::span<const Claim> claims, bool few_runs) {
  std::vector<double> p;
  for (const Claim& claim : claims) p.push_back(PValueOf(claim));
  const std::vector<double> adjusted = stats::Holm(p);
  std::vector<report::StudyClaim> checked;
  for (std::size_t i = 0; i < claims.size(); ++i) {
    const Claim& claim = claims[i];
    const std::string margin =
        claim.sign == Sign::kEqual ? fmt::format(" (within {:g})", claim.margin) : "";
    checked.push_back({.says = claim.says,
                       .compared = claim.compared,
                       .expected = fmt::format("{}{}", ExpectedText(claim.sign), margin),
                       .found = FoundText(claim, adjusted[i]),
                       .state = StateOf(claim, adjusted[i], few_runs)});
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
