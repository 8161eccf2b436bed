#include "tools/study/study_findings.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace fogline::study {
namespace {

constexpr double kPercent = 100;

std::string UnitOf(std::string_view measure) {
  return ComparedMetrics()[PlaceOfMetric(measure)].unit;
}

}  // namespace

std::string Capital(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

Estimate Turned(Estimate estimate) {
  estimate.mean = -estimate.mean;
  std::tie(estimate.low, estimate.high) = std::pair(-estimate.high, -estimate.low);
  return estimate;
}

std::vector<std::size_t> Distinct(const Comparison& comparison, std::size_t test_case,
                                  std::span<const std::size_t> variants) {
  std::vector<std::size_t> distinct;
  for (const std::size_t v : variants) {
    if (std::ranges::none_of(distinct, [&](std::size_t before) {
          return comparison.HasSameRuns({test_case, before}, {test_case, v});
        })) {
      distinct.push_back(v);
    }
  }
  return distinct;
}

std::vector<std::size_t> AllVariants(const Comparison& comparison) {
  std::vector<std::size_t> all(comparison.variants().size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::string SameRunsText(const Comparison& comparison, std::size_t test_case) {
  const std::vector<std::size_t> all = AllVariants(comparison);
  std::string text;
  for (const std::size_t first : Distinct(comparison, test_case, all)) {
    std::vector<std::string> same;
    for (std::size_t v = first + 1; v < all.size(); ++v) {
      if (comparison.HasSameRuns({test_case, first}, {test_case, v})) {
        same.push_back(comparison.variants()[v].name);
      }
    }
    if (same.empty()) continue;
    text += fmt::format("{}{} {} the same runs as {}, in every measure and with every seed.",
                        text.empty() ? "" : " ", Capital(ListText(same)),
                        same.size() == 1 ? "has" : "have", comparison.variants()[first].name);
  }
  return text.empty() ? text : text + " They are ranked once.";
}

std::string RankingText(const Comparison& comparison, std::size_t test_case,
                        std::string_view measure, int decimals, Better better) {
  std::vector<std::pair<std::size_t, Estimate>> ranked;
  for (const std::size_t v : Distinct(comparison, test_case, AllVariants(comparison))) {
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
  const bool less = difference.mean < 0;
  const Estimate size = less ? Turned(difference) : difference;
  std::string text =
      fmt::format("{} {} {}{}", Text(size, decimals), unit, less ? "less" : "more", than);
  const Verdict verdict = VerdictOf(difference);
  if (verdict == Verdict::kUndecided) {
    text += fmt::format(", which is not significant in {} pairs of runs", difference.n);
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
  for (const std::size_t v : Distinct(comparison, test_case, variants)) {
    if (comparison.HasSameRuns({test_case, v}, {test_case, reference})) continue;
    const Estimate difference =
        comparison.Difference({test_case, v}, {test_case, reference}, measure);
    const std::string& name = comparison.variants()[v].name;
    switch (VerdictOf(difference)) {
      case Verdict::kMore:
        more.push_back(fmt::format("{} (by {} {})", name, Text(difference, decimals), unit));
        break;
      case Verdict::kLess:
        less.push_back(
            fmt::format("{} (by {} {})", name, Text(Turned(difference), decimals), unit));
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
    parts.push_back(fmt::format("no significant difference for {}", ListText(undecided)));
  if (!too_few.empty()) {
    parts.push_back(fmt::format("too few runs for an interval for {}", ListText(too_few)));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::string CollisionText(const Comparison& comparison, std::size_t test_case) {
  std::vector<std::string> some;
  std::vector<std::string> none;
  for (const std::size_t v : Distinct(comparison, test_case, AllVariants(comparison))) {
    const metrics::EventShare share = comparison.Collisions({test_case, v});
    const std::string& name = comparison.variants()[v].name;
    if (share.events == 0) {
      none.push_back(name);
    } else {
      some.push_back(fmt::format("{} {}", name, Text(share)));
    }
  }
  const double upper = metrics::ClopperPearson(0, comparison.seeds()).upper * kPercent;
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

}  // namespace fogline::study
