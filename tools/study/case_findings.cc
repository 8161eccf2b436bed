#include "tools/study/case_findings.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "tools/study/study_findings.h"

namespace fogline::study {
namespace {

bool IsZeroThroughout(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return value == 0; });
}

/// "truck (268 of 300 runs instead of 0)".
std::string WithCollisions(const Comparison& comparison, std::size_t c, std::size_t variant,
                           std::size_t other) {
  const metrics::EventShare with = comparison.Collisions({c, variant});
  const metrics::EventShare without = comparison.Collisions({c, other});
  return fmt::format("{} ({} of {} runs instead of {})", comparison.cases()[c].name, with.events,
                     with.runs, without.events);
}

std::string LineOf(const Comparison& comparison, std::size_t c, std::size_t variant) {
  const std::string& label = comparison.cases()[c].name;
  if (const auto same = SameCase(comparison, c, variant, 0)) {
    return fmt::format("{}: the same runs as {}.", label, comparison.cases()[*same].name);
  }
  const metrics::EventShare without = comparison.Collisions({c, 0});
  const metrics::EventShare with = comparison.Collisions({c, variant});
  const std::int64_t cut_short = comparison.PairsCutShort({c, variant}, {c, 0});
  if (cut_short > 0) {
    return fmt::format(
        "{}: collisions {} instead of {}; the runs of {} of {} seeds end early, so SI and "
        "compromised safety are not compared.",
        label, Text(with), Text(without), cut_short, comparison.seeds());
  }
  const Estimate si = comparison.Mean({c, variant}, "si_pct");
  std::string line = fmt::format("{}: ", label);
  line += si.n == 0
              ? std::string(
                    "no run has an SI, because no run compromises safety without traded control")
              : fmt::format("SI {} % (n = {})", Text(si, 1), si.n);
  line += fmt::format(", mean compromised safety in fog {} m instead of {} m",
                      Text(comparison.Mean({c, variant}, kShortfall), 3),
                      Text(comparison.Mean({c, 0}, kShortfall), 3));
  const std::size_t reference = ReferenceCase(comparison, c);
  if (reference != c && si.n > 0 &&
      comparison.PairsCutShort({reference, variant}, {reference, 0}) == 0) {
    line += fmt::format(
        "; SI {}",
        DifferenceText(comparison.Difference({c, variant}, {reference, variant}, "si_pct"),
                       "points", 1,
                       fmt::format(" than with {}", comparison.cases()[reference].name)));
  }
  return line + ".";
}

}  // namespace

Verdict CompareCollisions(const Comparison& comparison, Cell a, Cell b) {
  constexpr double kEven = 0.5;
  const std::span<const double> of_a = comparison.Values(a, "collided");
  const std::span<const double> of_b = comparison.Values(b, "collided");
  std::int64_t only_a = 0;
  std::int64_t only_b = 0;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    if (of_a[i] > 0 && !(of_b[i] > 0)) ++only_a;
    if (of_b[i] > 0 && !(of_a[i] > 0)) ++only_b;
  }
  if (only_a + only_b == 0) return Verdict::kUndecided;
  const metrics::EventShare share = metrics::ClopperPearson(only_a, only_a + only_b);
  if (share.lower > kEven) return Verdict::kMore;
  if (share.upper < kEven) return Verdict::kLess;
  return Verdict::kUndecided;
}

CaseVerdict VerdictOfCase(const Comparison& comparison, std::size_t test_case, std::size_t variant,
                          std::size_t other) {
  const Cell with{test_case, variant};
  const Cell without{test_case, other};
  const Verdict collisions = CompareCollisions(comparison, with, without);
  if (collisions == Verdict::kMore) return CaseVerdict::kCollidesMore;
  if (collisions == Verdict::kLess) return CaseVerdict::kCollidesLess;
  if (comparison.PairsCutShort(with, without) > 0) return CaseVerdict::kCutShort;
  if (IsZeroThroughout(comparison.Values(with, kShortfall)) &&
      IsZeroThroughout(comparison.Values(without, kShortfall))) {
    return CaseVerdict::kNothing;
  }
  switch (VerdictOf(comparison.Difference(with, without, kShortfall))) {
    case Verdict::kLess:
      return CaseVerdict::kReduces;
    case Verdict::kMore:
      return CaseVerdict::kIncreases;
    case Verdict::kUndecided:
      return CaseVerdict::kUndecided;
    case Verdict::kTooFew:
      break;
  }
  return CaseVerdict::kTooFew;
}

std::optional<std::size_t> SameCase(const Comparison& comparison, std::size_t test_case,
                                    std::size_t variant, std::size_t other) {
  for (std::size_t c = 0; c < test_case; ++c) {
    if (comparison.HasSameRuns({c, variant}, {test_case, variant}) &&
        comparison.HasSameRuns({c, other}, {test_case, other})) {
      return c;
    }
  }
  return std::nullopt;
}

std::size_t ReferenceCase(const Comparison& comparison, std::size_t test_case) {
  const std::string& group = comparison.cases()[test_case].group;
  std::size_t reference = 0;
  while (comparison.cases()[reference].group != group) ++reference;
  return reference;
}

std::string VerdictFinding(const Comparison& comparison, std::size_t variant, std::size_t other) {
  std::map<CaseVerdict, std::vector<std::string>> by_verdict;
  std::vector<std::string> same;
  std::vector<std::string> same_runs;  // with both variants
  for (std::size_t c = 0; c < comparison.cases().size(); ++c) {
    const std::string& label = comparison.cases()[c].name;
    if (comparison.HasSameRuns({c, variant}, {c, other})) {
      same_runs.push_back(label);
      continue;
    }
    if (const auto before = SameCase(comparison, c, variant, other)) {
      same.push_back(fmt::format("{} ({})", label, comparison.cases()[*before].name));
      continue;
    }
    const CaseVerdict verdict = VerdictOfCase(comparison, c, variant, other);
    const bool collides =
        verdict <= CaseVerdict::kCutShort;  // the verdicts up to this one are about collisions
    by_verdict[verdict].push_back(collides ? WithCollisions(comparison, c, variant, other) : label);
  }
  const auto list = [](std::string_view what, const std::vector<std::string>& of) {
    return of.empty() ? std::string() : fmt::format(" {}: {}.", what, ListText(of));
  };
  const auto part = [&](CaseVerdict verdict, std::string_view what) {
    return list(what, by_verdict[verdict]);
  };
  const std::string& name = comparison.variants()[variant].name;
  const std::string& than = comparison.variants()[other].name;
  const std::size_t counted = comparison.cases().size() - same.size() - same_runs.size() -
                              by_verdict[CaseVerdict::kNothing].size();
  std::string text = fmt::format(
      "{} against {}, in {} counted cases. It collides more often in {} of them. It reduces the "
      "compromised safety in fog in {} of those in which every run lasts.",
      Capital(name), than, counted, by_verdict[CaseVerdict::kCollidesMore].size(),
      by_verdict[CaseVerdict::kReduces].size());
  text += part(CaseVerdict::kCollidesMore, "It collides more in");
  text += part(CaseVerdict::kCollidesLess, "It collides less in");
  text += part(CaseVerdict::kCutShort,
               "Runs end in collisions about as often with both, so safety is not compared in");
  text += part(CaseVerdict::kReduces, "It reduces compromised safety in");
  text += part(CaseVerdict::kIncreases, "It increases compromised safety in");
  text += part(CaseVerdict::kUndecided, "It makes no significant difference in");
  text += part(CaseVerdict::kTooFew, "Too few runs for an interval in");
  text += part(CaseVerdict::kNothing, "Not counted, because neither compromises safety in any run");
  text += list(fmt::format("Not counted, because the runs are those of {}", than), same_runs);
  text += list("Not counted, because they have the runs of another case (in brackets)", same);
  return text;
}

std::vector<std::string> CaseFindings(const Comparison& comparison, std::size_t variant) {
  std::vector<std::string> findings{VerdictFinding(comparison, variant, 0)};
  for (std::size_t c = 0; c < comparison.cases().size(); ++c) {
    findings.push_back(LineOf(comparison, c, variant));
  }
  return findings;
}

}  // namespace fogline::study
