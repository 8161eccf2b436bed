#include "tools/study/ensemble/robustness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "tools/stats/holm.h"
#include "tools/study/claims.h"

namespace fogline::study {
namespace {

constexpr double kSurelyBelow = 0.05;

/// p-value of the side on which the difference lies, and whether this side is the claim's.
struct OneSide {
  bool is_claimed;
  double p;
};

/// The estimate moved by so much.
Estimate Moved(Estimate estimate, double by) {
  for (double* value : {&estimate.mean, &estimate.low, &estimate.high}) *value += by;
  return estimate;
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
  // The bound that is nearer to the mean, or the only one.
  const bool is_below = bound == Bound::kBoth ? mean < 0 : bound == Bound::kBelow;
  const Estimate beyond = Moved(claim.difference, is_below ? claim.margin : -claim.margin);
  const bool is_within = is_below ? beyond.mean >= 0 : beyond.mean <= 0;
  if (bound == Bound::kBoth && is_within) return {true, PValueOf(claim)};
  return {is_within, PValueOfSign(beyond)};
}

/// A claim of equality that a finding uses on one side only, as a claim on the sign of the
/// difference from this bound. Other claims stay as they are.
Claim BoundAsSign(Claim claim, Bound bound) {
  if (claim.sign != Sign::kEqual || bound == Bound::kBoth) return claim;
  const bool is_below = bound == Bound::kBelow;
  claim.sign = is_below ? Sign::kMore : Sign::kLess;
  claim.difference = Moved(claim.difference, is_below ? claim.margin : -claim.margin);
  claim.compared += fmt::format(", difference from {:g}", is_below ? -claim.margin : claim.margin);
  claim.margin = 0;
  return claim;
}

InSet ExpectedOf(const ExaminedFinding& finding, std::string_view says, int set) {
  for (const KnownException& one : finding.exceptions) {
    if (one.says == says && std::ranges::count(one.sets, set) > 0) return one.outcome;
  }
  return InSet::kHolds;
}

/// "set 3: "..." is opposite" for each outcome that the author does not say; "" without one.
std::string Surprises(const ExaminedFinding& finding,
                      std::span<const std::vector<JudgedInSet>> judged) {
  std::string text;
  for (std::size_t c = 0; c < judged.size(); ++c) {
    const std::string_view says = finding.central[c].says;
    for (std::size_t s = 0; s < judged[c].size(); ++s) {
      const int number = static_cast<int>(s) + 1;
      const InSet found = judged[c][s].outcome;
      if (found == ExpectedOf(finding, says, number)) continue;
      text += fmt::format("{}set {}: \"{}\" {}", text.empty() ? "" : "; ", number, says,
                          found == InSet::kHolds ? "holds" : fmt::format("is {}", Text(found)));
    }
  }
  return text;
}

std::vector<int> InOrder(const std::set<int>& numbers) { return {numbers.begin(), numbers.end()}; }

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

std::vector<int> SetsWithout(std::span<const std::vector<JudgedInSet>> claims) {
  std::set<int> numbers;
  for (const std::vector<JudgedInSet>& outcomes : claims) {
    for (std::size_t s = 0; s < outcomes.size(); ++s) {
      if (outcomes[s].outcome != InSet::kHolds) numbers.insert(static_cast<int>(s) + 1);
    }
  }
  return InOrder(numbers);
}

std::vector<int> SetsWithout(const ExaminedFinding& finding) {
  std::set<int> numbers;
  for (const KnownException& one : finding.exceptions) {
    numbers.insert(one.sets.begin(), one.sets.end());
  }
  return InOrder(numbers);
}

std::string SetsText(std::span<const int> numbers) {
  std::string text = numbers.size() == 1 ? "set " : "sets ";
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool is_last = i + 1 == numbers.size();
    text += fmt::format("{}{}", i == 0 ? "" : is_last ? " and " : ", ", numbers[i]);
  }
  return text;
}

std::string SentenceOf(const ExaminedFinding& finding, std::size_t sets) {
  constexpr std::array<std::string_view, 11> kWords{
      "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"};
  const std::vector<int> without = SetsWithout(finding);
  const std::string count =
      sets < kWords.size() ? std::string(kWords[sets]) : fmt::format("{}", sets);
  if (without.empty()) return fmt::format("Holds in all {} parameter sets.", count);
  if (without.size() == sets) {
    return fmt::format("Holds in none of the {} parameter sets: {}", count, finding.why);
  }
  return fmt::format("Does not hold in {}: {}", SetsText(without), finding.why);
}

Claim ClaimOnFinding(const ExaminedFinding& finding, std::span<const ClaimInSets> claims,
                     std::span<const std::vector<JudgedInSet>> judged) {
  std::optional<Claim> weakest;
  double p = -1;
  for (std::size_t c = 0; c < claims.size(); ++c) {
    for (std::size_t s = 0; s < judged[c].size(); ++s) {
      if (judged[c][s].outcome != InSet::kHolds || judged[c][s].p <= p) continue;
      p = judged[c][s].p;
      weakest = BoundAsSign(claims[c].sets[s], claims[c].quoted.bound);
    }
  }
  const std::size_t sets = judged.empty() ? 0 : judged.front().size();
  std::string sentence = SentenceOf(finding, sets);
  sentence[0] = static_cast<char>(sentence[0] - 'A' + 'a');
  Claim claim = weakest.value_or(Claim{});
  claim.says = fmt::format("Finding {} {}", finding.number, sentence);
  claim.compared = "no comparison holds in any set";
  if (weakest) {
    claim.compared =
        fmt::format("{} comparison{} in each of {} sets; least certain of those that hold: {}",
                    claims.size(), claims.size() == 1 ? "" : "s", sets, weakest->compared);
  }
  claim.hindrance = Surprises(finding, judged);
  if (claim.hindrance.empty() && !weakest) claim.hindrance = "no comparison holds";
  return claim;
}

}  // namespace fogline::study
