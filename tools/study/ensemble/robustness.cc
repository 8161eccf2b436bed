#include "tools/study/ensemble/robustness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "tools/stats/holm.h"
#include "tools/study/claims.h"

namespace fogline::study {
namespace {

constexpr double kSurelyBelow = 0.05;

/// The side of 0, or of a bound, on which the difference is. `is_claimed` is true if the claim
/// states this side. `p` is the p-value of the statement that the difference is on this side.
struct OneSide {
  bool is_claimed;
  double p;
};

/// The estimate with `by` added to the mean and to both ends of the interval.
Estimate Moved(Estimate estimate, double by) {
  for (double* value : {&estimate.mean, &estimate.low, &estimate.high}) *value += by;
  return estimate;
}

/// Whether the lower bound decides a claim of equality. If the claim has both bounds, the bound
/// nearer to the mean decides.
bool IsAtLowerBound(const Claim& claim, Bound bound) {
  return bound == Bound::kBoth ? claim.difference.mean < 0 : bound == Bound::kBelow;
}

/// The claim's difference minus one bound of the claim. The lower bound is -margin, and the upper
/// bound is +margin.
Estimate FromBound(const Claim& claim, bool is_lower) {
  return Moved(claim.difference, is_lower ? claim.margin : -claim.margin);
}

OneSide SideOf(const Claim& claim, Bound bound) {
  if (!claim.hindrance.empty() || !claim.difference.has_interval()) return {false, 1};
  const double mean = claim.difference.mean;
  switch (claim.sign) {
    case Sign::kLess:
      return {mean < 0, PValueOf(claim)};
    case Sign::kMore:
      return {mean > 0, PValueOf(claim)};
    case Sign::kEqual:
      break;
  }
  const bool is_lower = IsAtLowerBound(claim, bound);
  const Estimate beyond = FromBound(claim, is_lower);
  const bool is_within = is_lower ? beyond.mean >= 0 : beyond.mean <= 0;
  if (bound == Bound::kBoth && is_within) return {true, PValueOf(claim)};
  return {is_within, PValueOfSign(beyond)};
}

Sign Turned(Sign sign) { return sign == Sign::kLess ? Sign::kMore : Sign::kLess; }

/// The claim that the runs support. If the outcome is opposite, the result has the other sign. A
/// claim of equality may be decided at one bound. The result then claims that the difference from
/// this bound is above 0, or that it is below 0.
Claim AsDecided(Claim claim, Bound bound, InSet outcome) {
  const bool holds = outcome == InSet::kHolds;
  if (claim.sign != Sign::kEqual) {
    if (!holds) claim.sign = Turned(claim.sign);
    return claim;
  }
  if (holds && bound == Bound::kBoth) return claim;
  const bool is_lower = IsAtLowerBound(claim, bound);
  const Sign within = is_lower ? Sign::kMore : Sign::kLess;
  claim.sign = holds ? within : Turned(within);
  claim.difference = FromBound(claim, is_lower);
  claim.compared += fmt::format(", difference from {:g}", is_lower ? -claim.margin : claim.margin);
  claim.margin = 0;
  return claim;
}

InSet ExpectedOf(const ExaminedPart& examined, std::string_view says, int set) {
  for (const KnownException& one : examined.exceptions) {
    if (one.says == says && std::ranges::count(one.sets, set) > 0) return one.outcome;
  }
  return InSet::kHolds;
}

/// A text such as "set 3: "..." is opposite" for each outcome that differs from the outcome that
/// the author states; "" if there is no such outcome.
std::string Surprises(const ExaminedPart& examined,
                      std::span<const std::vector<JudgedInSet>> judged) {
  std::string text;
  for (std::size_t c = 0; c < judged.size(); ++c) {
    const std::string_view says = examined.claims[c].says;
    for (std::size_t s = 0; s < judged[c].size(); ++s) {
      const int number = static_cast<int>(s) + 1;
      const InSet found = judged[c][s].outcome;
      if (found == ExpectedOf(examined, says, number)) continue;
      text += fmt::format("{}set {}: \"{}\" {}", text.empty() ? "" : "; ", number, says,
                          found == InSet::kHolds ? "holds" : fmt::format("is {}", Text(found)));
    }
  }
  return text;
}

/// The number as a word, such as "eight".
std::string CountText(std::size_t count) {
  constexpr std::array<std::string_view, 11> kWords{
      "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"};
  return count < kWords.size() ? std::string(kWords[count]) : fmt::format("{}", count);
}

}  // namespace

std::string_view Text(InSet outcome) {
  switch (outcome) {
    case InSet::kHolds:
      return "holds";
    case InSet::kOpposite:
      return "opposite";
    case InSet::kUndecided:
      break;
  }
  return "undecided";
}

std::vector<std::vector<JudgedInSet>> JudgeInSets(std::span<const ClaimInSets> claims) {
  std::vector<OneSide> sides;
  std::vector<double> p;
  for (const ClaimInSets& claim : claims) {
    for (const Claim& in_set : claim.sets) {
      p.push_back(sides.emplace_back(SideOf(in_set, claim.quoted.bound)).p);
    }
  }
  const std::vector<double> adjusted = stats::Holm(p);
  std::vector<std::vector<JudgedInSet>> judged;
  std::size_t i = 0;
  for (const ClaimInSets& claim : claims) {
    std::vector<JudgedInSet>& outcomes = judged.emplace_back();
    for (std::size_t s = 0; s < claim.sets.size(); ++s, ++i) {
      const InSet decided = sides[i].is_claimed ? InSet::kHolds : InSet::kOpposite;
      outcomes.push_back({.outcome = adjusted[i] < kSurelyBelow ? decided : InSet::kUndecided,
                          .p = p[i],
                          .p_holm = adjusted[i]});
    }
  }
  return judged;
}

std::string_view Text(Part part) { return part == Part::kHeading ? "heading" : "side claims"; }

InSet VerdictOn(std::span<const InSet> claims) {
  if (std::ranges::count(claims, InSet::kOpposite) > 0) return InSet::kOpposite;
  return std::ranges::count(claims, InSet::kUndecided) > 0 ? InSet::kUndecided : InSet::kHolds;
}

std::vector<InSet> VerdictsOn(std::span<const std::vector<JudgedInSet>> claims) {
  std::vector<InSet> verdicts;
  const std::size_t sets = claims.empty() ? 0 : claims.front().size();
  for (std::size_t s = 0; s < sets; ++s) {
    std::vector<InSet> in_set;
    for (const std::vector<JudgedInSet>& claim : claims) in_set.push_back(claim[s].outcome);
    verdicts.push_back(VerdictOn(in_set));
  }
  return verdicts;
}

std::vector<InSet> VerdictsOn(const ExaminedPart& examined, std::size_t sets) {
  std::vector<InSet> verdicts;
  for (std::size_t s = 0; s < sets; ++s) {
    std::vector<InSet> in_set;
    for (const QuotedClaim& claim : examined.claims) {
      in_set.push_back(ExpectedOf(examined, claim.says, static_cast<int>(s) + 1));
    }
    verdicts.push_back(VerdictOn(in_set));
  }
  return verdicts;
}

std::string SetsText(std::span<const int> numbers, std::size_t sets) {
  if (numbers.size() == sets) return fmt::format("all {} parameter sets", CountText(sets));
  std::string text = numbers.size() == 1 ? "set " : "sets ";
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool is_last = i + 1 == numbers.size();
    text += fmt::format("{}{}", i == 0 ? "" : is_last ? " and " : ", ", numbers[i]);
  }
  return text;
}

std::string SentenceOf(const ExaminedFinding& finding, Part part, std::size_t sets) {
  const ExaminedPart& examined = finding.Of(part);
  const std::vector<InSet> verdicts = VerdictsOn(examined, sets);
  std::string text;
  for (const InSet verdict : {InSet::kHolds, InSet::kOpposite, InSet::kUndecided}) {
    std::vector<int> numbers;
    for (std::size_t s = 0; s < sets; ++s) {
      if (verdicts[s] == verdict) numbers.push_back(static_cast<int>(s) + 1);
    }
    if (numbers.empty()) continue;
    const bool is_plural = part == Part::kSide && verdict == InSet::kHolds;
    text += fmt::format("{}{} in {}", text.empty() ? "" : "; ", is_plural ? "hold" : Text(verdict),
                        SetsText(numbers, sets));
  }
  return fmt::format("{}.{}{}", text, examined.why.empty() ? "" : " ", examined.why);
}

Claim ClaimOnPart(const ExaminedFinding& finding, Part part, std::span<const ClaimInSets> claims,
                  std::span<const std::vector<JudgedInSet>> judged) {
  std::optional<Claim> weakest;
  double p = -1;
  for (std::size_t c = 0; c < claims.size(); ++c) {
    for (std::size_t s = 0; s < judged[c].size(); ++s) {
      const JudgedInSet& one = judged[c][s];
      if (one.outcome == InSet::kUndecided || one.p <= p) continue;
      p = one.p;
      weakest = AsDecided(claims[c].sets[s], claims[c].quoted.bound, one.outcome);
      weakest->p_holm = one.p_holm;
    }
  }
  const std::size_t sets = judged.empty() ? 0 : judged.front().size();
  Claim claim = weakest.value_or(Claim{});
  claim.says = fmt::format("Finding {}, {}: {}", finding.number, Text(part),
                           SentenceOf(finding, part, sets));
  claim.compared = "no comparison is decided in any set";
  if (weakest) {
    claim.compared = fmt::format(
        "{} comparison{} in each of {} sets; least certain of those that are decided: "
        "{}",
        claims.size(), claims.size() == 1 ? "" : "s", sets, weakest->compared);
  }
  claim.hindrance = Surprises(finding.Of(part), judged);
  if (claim.hindrance.empty() && !weakest) claim.hindrance = "no comparison is decided";
  return claim;
}

}  // namespace fogline::study
