#include "tools/study/findings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "tools/report/html.h"

namespace fogline {
namespace {

constexpr double kPercent = 100;

std::string UnitOf(std::string_view measure) {
  return ComparedMeasures()[PlaceOfMeasure(measure)].unit;
}

}  // namespace

std::string Capital(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string RankingText(const Comparison& comparison, std::size_t test_case,
                        std::string_view measure, int decimals, Better better) {
  std::vector<std::pair<std::size_t, Estimate>> ranked;
  for (std::size_t v = 0; v < comparison.variants().size(); ++v) {
    const Estimate mean = comparison.Mean({test_case, v}, measure);
    if (mean.n > 0) ranked.emplace_back(v, mean);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [&](const auto& a, const auto& b) {
    return better == Better::kMore ? a.second.mean > b.second.mean : a.second.mean < b.second.mean;
  });
  const std::string unit = UnitOf(measure);
  std::string text = Capital(NameForReaders(measure));
  if (ranked.empty()) return text + ": no run has one.";
  if (!unit.empty()) text += fmt::format(" in {}", unit);
  text += ", best first: ";
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ", comparison.variants()[ranked[i].first].name,
                        Text(ranked[i].second, decimals));
  }
  return text + ".";
}

std::string DifferenceText(const Estimate& difference, std::string_view unit, int decimals,
                           std::string_view than) {
  if (difference.n == 0) {
    return difference.infinite == 0
               ? std::string("without a pair of runs to compare")
               : fmt::format("infinitely far apart in {} pairs of runs", difference.infinite);
  }
  Estimate size = difference;
  const bool less = difference.mean < 0;
  if (less) {
    size.mean = -difference.mean;
    size.low = -difference.high;
    size.high = -difference.low;
  }
  std::string text =
      fmt::format("{} {} {}{}", Text(size, decimals), unit, less ? "less" : "more", than);
  const Verdict verdict = VerdictOf(difference);
  if (verdict == Verdict::kUndecided) {
    text += fmt::format(", which is no difference that {} pairs of runs can tell", difference.n);
  }
  if (verdict == Verdict::kTooFew) text += ", with too few runs for an interval";
  return text;
}

std::string ListText(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i];
  }
  return text;
}

std::string AgainstText(const Comparison& comparison, std::size_t test_case,
                        const std::vector<std::size_t>& variants, std::size_t reference,
                        std::string_view measure, std::string_view unit, int decimals) {
  std::vector<std::string> more;
  std::vector<std::string> less;
  std::vector<std::string> undecided;
  std::vector<std::string> too_few;
  for (const std::size_t v : variants) {
    if (v == reference) continue;
    const Estimate difference =
        comparison.Difference({test_case, v}, {test_case, reference}, measure);
    const std::string& name = comparison.variants()[v].name;
    switch (VerdictOf(difference)) {
      case Verdict::kMore:
        more.push_back(fmt::format("{} (by {} {})", name, Text(difference, decimals), unit));
        break;
      case Verdict::kLess:
        less.push_back(fmt::format("{} (by {} {})", name, Text(difference, decimals), unit));
        break;
      case Verdict::kUndecided:
        undecided.push_back(name);
        break;
      case Verdict::kTooFew:
        too_few.push_back(name);
        break;
    }
  }
  std::vector<std::string> parts;
  if (!less.empty()) parts.push_back(fmt::format("less for {}", ListText(less)));
  if (!more.empty()) parts.push_back(fmt::format("more for {}", ListText(more)));
  if (!undecided.empty())
    parts.push_back(fmt::format("not to be told apart for {}", ListText(undecided)));
  if (!too_few.empty()) {
    parts.push_back(fmt::format("too few runs for an interval for {}", ListText(too_few)));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::string CollisionText(const Comparison& comparison, std::size_t test_case) {
  std::vector<std::string> some;
  std::vector<std::string> none;
  for (std::size_t v = 0; v < comparison.variants().size(); ++v) {
    const EventShare share = comparison.Collisions({test_case, v});
    const std::string& name = comparison.variants()[v].name;
    if (share.events == 0) {
      none.push_back(name);
    } else {
      some.push_back(fmt::format("{} {}", name, Text(share)));
    }
  }
  const double upper = ClopperPearson(0, comparison.seeds()).upper * kPercent;
  if (some.empty()) {
    return fmt::format(
        "No car collides in any run: with 0 of {}, the probability is at most {:.2g} %.",
        comparison.seeds(), upper);
  }
  std::string text = fmt::format("Collisions: {}.", ListText(some));
  if (!none.empty()) {
    text += fmt::format(" None with {} (0 of {}: at most {:.2g} %).", ListText(none),
                        comparison.seeds(), upper);
  }
  return text;
}

std::size_t ReferenceCase(const Comparison& comparison, std::size_t test_case) {
  const std::string& group = comparison.cases()[test_case].group;
  std::size_t reference = 0;
  while (comparison.cases()[reference].group != group) ++reference;
  return reference;
}

std::vector<std::string> CaseFindings(const Comparison& comparison, std::size_t variant) {
  constexpr std::string_view kShortfall = "mean_compromised_safety_fog_m";
  std::map<Verdict, std::vector<std::string>> by_verdict;
  std::vector<std::string> lines;
  const std::string& name = comparison.variants()[variant].name;
  for (std::size_t c = 0; c < comparison.cases().size(); ++c) {
    const std::string& label = comparison.cases()[c].name;
    const Estimate effect = comparison.Difference({c, variant}, {c, 0}, kShortfall);
    by_verdict[VerdictOf(effect)].push_back(label);
    const EventShare without = comparison.Collisions({c, 0});
    const EventShare with = comparison.Collisions({c, variant});
    std::string line = fmt::format(
        "{}: SI {} % (n = {}), mean compromised safety in fog {} m instead of {} m", label,
        Text(comparison.Mean({c, variant}, "si_pct"), 1), comparison.Mean({c, variant}, "si_pct").n,
        Text(comparison.Mean({c, variant}, kShortfall), 3),
        Text(comparison.Mean({c, 0}, kShortfall), 3));
    if (without.events + with.events > 0) {
      line += fmt::format("; collisions {} instead of {}", Text(with), Text(without));
    }
    const std::size_t reference = ReferenceCase(comparison, c);
    if (reference != c) {
      line += fmt::format(
          "; SI {}",
          DifferenceText(comparison.Difference({c, variant}, {reference, variant}, "si_pct"),
                         "points", 1,
                         fmt::format(" than with {}", comparison.cases()[reference].name)));
    }
    lines.push_back(line + ".");
  }
  const auto part = [&](Verdict verdict, std::string_view what) {
    const std::vector<std::string>& of = by_verdict[verdict];
    return of.empty() ? std::string() : fmt::format(" {}: {}.", what, ListText(of));
  };
  std::vector<std::string> findings;
  findings.push_back(fmt::format(
      "{} reduces the compromised safety in fog in {} of {} cases.{}{}{}{}", Capital(name),
      by_verdict[Verdict::kLess].size(), comparison.cases().size(),
      part(Verdict::kLess, "It reduces it in"), part(Verdict::kMore, "It increases it in"),
      part(Verdict::kUndecided, "It makes no difference that can be told in"),
      part(Verdict::kTooFew, "Too few runs for an interval in")));
  findings.insert(findings.end(), lines.begin(), lines.end());
  return findings;
}

}  // namespace fogline
