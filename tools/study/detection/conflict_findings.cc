#include "tools/study/detection/conflict_findings.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "services/decision/conflict/conflict_measures.h"
#include "tools/study/study_findings.h"

namespace fogline::study {
namespace {

/// Name of a measure with its twin, such as "cusum (sprt is the same test)".
std::string NameWithTwin(std::size_t measure) {
  std::string name(NameOfMeasure(measure));
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    if (TwinOf(row.name) == name) name += fmt::format(" ({} is the same test)", row.name);
  }
  return name;
}

/// Measures without a determined threshold, of two kinds.
struct Unranked {
  std::vector<std::string> never;   // without an alarm in clear air
  std::vector<std::string> seldom;  // with too few alarms
};

Unranked UnrankedOf(const ConflictSet& set) {
  Unranked unranked;
  for (std::size_t m = 0; m < set.thresholds.size(); ++m) {
    const DetectorThreshold& threshold = set.thresholds[m];
    if (threshold.is_determined()) continue;
    (threshold.calibrated.alarms == 0 ? unranked.never : unranked.seldom)
        .emplace_back(NameOfMeasure(m));
  }
  return unranked;
}

std::string UnrankedText(const ConflictSet& set) {
  const auto [never, seldom] = UnrankedOf(set);
  std::string text;
  if (!never.empty()) {
    text += fmt::format(
        " Not ranked: {}. At their smallest quiet threshold they never alarm in clear air, and "
        "below it they alarm too often.",
        ListText(never));
  }
  if (!seldom.empty()) {
    text += fmt::format(
        " Not ranked: {}. At their smallest quiet threshold, alarms are more than {:g} times as "
        "rare as required.",
        ListText(seldom), kLoosest);
  }
  return text;
}

/// The names as text, shortened if there are many.
std::string Listed(std::vector<std::string> names) {
  constexpr std::size_t kMost = 6;
  if (names.size() <= kMost) return ListText(names);
  const std::size_t more = names.size() - kMost;
  names.resize(kMost);
  names.push_back(fmt::format("{} more", more));
  return ListText(names);
}

/// Compares the other measures with the Degree of Conflict, which is measure 0.
std::string AgainstDoc(const ConflictSet& set, std::span<const std::size_t> ranked) {
  std::map<Verdict, std::vector<std::string>> by_verdict;
  for (const std::size_t m : ranked) {
    if (m != 0) by_verdict[VerdictOf(set.means[m].delay_minus_doc_s)].push_back(NameWithTwin(m));
  }
  std::string text;
  const auto add = [&](Verdict verdict, std::string_view one, std::string_view many) {
    const std::vector<std::string>& names = by_verdict[verdict];
    if (names.empty()) return;
    text += fmt::format(" {} other {}: {}.", names.size(), names.size() == 1 ? one : many,
                        Listed(names));
  };
  add(Verdict::kLess, "measure is sooner", "measures are sooner");
  add(Verdict::kMore, "measure is later", "measures are later");
  add(Verdict::kUndecided, "measure does not differ significantly",
      "measures do not differ significantly");
  add(Verdict::kTooFew, "measure has too few runs for an interval",
      "measures have too few runs for an interval");
  return text;
}

/// Whether a measure alarms as often in other runs in clear air as in those from which its
/// threshold was found. Given the alarms in both sets, those in the other runs have a binomial
/// distribution.
bool AlarmsAsCalibrated(const DetectorThreshold& threshold) {
  const AlarmCount& found = threshold.calibrated;
  const AlarmCount& other = threshold.clear;
  const metrics::EventShare share =
      metrics::ClopperPearson(other.alarms, found.alarms + other.alarms);
  const double expected = other.time_s / (found.time_s + other.time_s);
  return share.lower <= expected && expected <= share.upper;
}

}  // namespace

std::string_view NameOfMeasure(std::size_t measure) {
  return conflict::ConflictMeasures()[measure].name;
}

std::string NameOfSet(const ConflictSet& set) {
  return fmt::format("{}, {} noise", set.fog, set.noise);
}

std::vector<std::size_t> Rank(const ConflictSet& set) {
  std::vector<std::size_t> ranked;
  for (std::size_t m = 0; m < set.thresholds.size(); ++m) {
    if (set.thresholds[m].is_determined()) ranked.push_back(m);
  }
  std::ranges::stable_sort(ranked, {}, [&](std::size_t m) { return set.means[m].delay_s.mean; });
  return ranked;
}

std::vector<std::size_t> WithoutTwins(std::span<const std::size_t> ranked) {
  std::vector<std::size_t> own;
  for (const std::size_t m : ranked) {
    const std::string_view twin = TwinOf(NameOfMeasure(m));
    const bool is_told = std::ranges::any_of(
        ranked, [&](std::size_t other) { return NameOfMeasure(other) == twin; });
    if (!is_told) own.push_back(m);
  }
  return own;
}

std::string ArlText(const AlarmCount& clear) {
  const auto [low, high] = clear.ArlZeroBounds_s();
  return fmt::format("{} [{}, {}]", Text(clear.ArlZero_s(), 0), Text(low, 0), Text(high, 0));
}

std::string FindingOfSet(const ConflictSet& set, std::span<const std::size_t> ranked) {
  std::string text = fmt::format("Fog model {}:", NameOfSet(set));
  if (ranked.empty()) {
    return text + fmt::format(
                      " no measure has a threshold: {} runs of {:g} s in clear air have too few "
                      "alarms for a mean time of {:g} s between them.",
                      set.seeds, kClearRun_s, kArlZero_s);
  }
  text += fmt::format(" {} is first with a mean delay from fog to alarm of {} s",
                      NameWithTwin(ranked.front()), Text(set.means[ranked.front()].delay_s, 2));
  const auto doc = std::ranges::find(ranked, std::size_t{0});
  if (doc == ranked.end()) {
    text += "; the Degree of Conflict has no threshold.";
  } else {
    text += fmt::format("; the Degree of Conflict needs {} s and is number {} of {}.{}",
                        Text(set.means[0].delay_s, 2), doc - ranked.begin() + 1, ranked.size(),
                        AgainstDoc(set, ranked));
  }
  return text + UnrankedText(set);
}

std::string FindingOfArlZero(const ConflictSet& set, std::span<const std::size_t> ranked) {
  std::vector<std::string> others;
  std::int64_t as_calibrated = 0;
  for (const std::size_t m : ranked) {
    const DetectorThreshold& threshold = set.thresholds[m];
    if (!threshold.clear.MayHave(kArlZero_s)) {
      others.push_back(fmt::format("{} {} s", NameOfMeasure(m), ArlText(threshold.clear)));
    }
    as_calibrated += AlarmsAsCalibrated(threshold) ? 1 : 0;
  }
  return fmt::format("{}: {} of {}{}{} ({} agree with their calibration, up to chance)",
                     NameOfSet(set), ranked.size() - others.size(), ranked.size(),
                     others.empty() ? "" : ", but not ", ListText(others), as_calibrated);
}

}  // namespace fogline::study
