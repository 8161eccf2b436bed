// Study `conflict`: compares every measure of conflict as a detector of fog, at an equal rate of
// false alarms.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "services/decision/conflict/conflict_measures.h"
#include "tools/study/bootstrap.h"
#include "tools/study/detection/conflict_runs.h"
#include "tools/study/study.h"
#include "tools/study/study_findings.h"

namespace fogline::study {
namespace {

constexpr double kHour_s = 3600;

std::string_view NameOfMeasure(std::size_t measure) {
  return conflict::ConflictMeasures()[measure].name;
}

std::string NameOfSet(const ConflictSet& set) {
  return fmt::format("{}, {} noise", set.fog, set.noise);
}

/// Measures with a threshold, the shortest delay first.
std::vector<std::size_t> Rank(const ConflictSet& set) {
  std::vector<std::size_t> ranked;
  for (std::size_t m = 0; m < set.thresholds.size(); ++m) {
    if (set.thresholds[m].is_determined()) ranked.push_back(m);
  }
  std::ranges::stable_sort(ranked, {}, [&](std::size_t m) { return set.means[m].delay_s.mean; });
  return ranked;
}

/// Measures without those that are the same test as an earlier one: a twin is named with that
/// measure and counts once.
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
  std::vector<std::string> sooner;
  std::vector<std::string> later;
  std::vector<std::string> undecided;
  std::vector<std::string> too_few;
  for (const std::size_t m : ranked) {
    if (m == 0) continue;
    const std::string name = NameWithTwin(m);
    switch (VerdictOf(set.means[m].delay_minus_doc_s)) {
      case Verdict::kLess:
        sooner.push_back(name);
        break;
      case Verdict::kMore:
        later.push_back(name);
        break;
      case Verdict::kUndecided:
        undecided.push_back(name);
        break;
      case Verdict::kTooFew:
        too_few.push_back(name);
        break;
    }
  }
  std::string text;
  const auto add = [&](const std::vector<std::string>& names, std::string_view one,
                       std::string_view many) {
    if (names.empty()) return;
    text += fmt::format(" {} other {}: {}.", names.size(), names.size() == 1 ? one : many,
                        Listed(names));
  };
  add(sooner, "measure is sooner", "measures are sooner");
  add(later, "measure is later", "measures are later");
  add(undecided, "measure does not differ significantly", "measures do not differ significantly");
  add(too_few, "measure has too few runs for an interval",
      "measures have too few runs for an interval");
  return text;
}

std::string FindingOf(const ConflictSet& set, std::span<const std::size_t> ranked) {
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

std::string ArlText(const AlarmCount& clear) {
  const auto [low, high] = clear.ArlZeroBounds_s();
  return fmt::format("{} [{}, {}]", Text(clear.ArlZero_s(), 0), Text(low, 0), Text(high, 0));
}

/// Says whether thresholds keep their rate of false alarms in runs from which they were not found.
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

std::string PercentText(const Estimate& share) {
  Estimate percent = share;
  for (double* value : {&percent.mean, &percent.low, &percent.high}) *value *= 100;
  return Text(percent, 0);
}

report::StudyTable TableOf(const ConflictSet& set, std::span<const std::size_t> ranked) {
  report::StudyTable table{
      .caption = fmt::format("Fog model {}: mean over visibilities, soonest first", NameOfSet(set)),
      .columns = {"measure", "fog to alarm (s)", "difference from DoC (s)", "AUC",
                  "ARL0 in other clear runs (s)"}};
  for (const double visibility_m : kVisibilities_m) {
    table.columns.push_back(fmt::format("detected at {:g} m (%)", visibility_m));
  }
  const auto add = [&](std::size_t m) {
    const bool has_threshold = set.thresholds[m].is_determined();
    const DetectorMean& mean = set.means[m];
    std::vector<std::string>& row = table.rows.emplace_back();
    row = {std::string(NameOfMeasure(m)), has_threshold ? Text(mean.delay_s, 2) : "no threshold",
           Text(mean.delay_minus_doc_s, 2), Text(mean.auc, 3),
           has_threshold ? ArlText(set.thresholds[m].clear) : "–"};
    for (const ConflictOutcome& outcome : set.outcomes) {
      row.push_back(PercentText(outcome.detectors[m].detection));
    }
  };
  for (const std::size_t m : ranked) add(m);
  for (std::size_t m = 0; m < set.thresholds.size(); ++m) {
    if (!set.thresholds[m].is_determined()) add(m);
  }
  return table;
}

std::string CsvOf(std::span<const ConflictSet> sets) {
  std::string csv =
      "fog,visibility_m,noise,measure,n,has_threshold,threshold,calibration_alarms,"
      "calibrated_arl0_s,clear_alarms,arl0_s,arl0_ci95_low_s,arl0_ci95_high_s,detected,p_detected,"
      "p_ci95_low,p_ci95_high,delay_s,delay_ci95_low_s,delay_ci95_high_s,delay_if_detected_s,"
      "delay_minus_doc_s,delay_minus_doc_ci95_low_s,delay_minus_doc_ci95_high_s,auc,auc_ci95_low,"
      "auc_ci95_high,auc_minus_doc,auc_minus_doc_ci95_low,auc_minus_doc_ci95_high\n";
  for (const ConflictSet& set : sets) {
    for (const ConflictOutcome& outcome : set.outcomes) {
      for (std::size_t m = 0; m < outcome.detectors.size(); ++m) {
        const DetectorOutcome& one = outcome.detectors[m];
        const DetectorThreshold& at = set.thresholds[m];
        const auto [arl_low, arl_high] = at.clear.ArlZeroBounds_s();
        const bool there = at.is_determined();
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}", set.fog,
                           outcome.condition.visibility_m, set.noise, NameOfMeasure(m), set.seeds,
                           there ? "yes" : "no", CsvText(at.threshold), at.calibrated.alarms,
                           CsvText(at.calibrated.ArlZero_s()), at.clear.alarms,
                           CsvText(at.clear.ArlZero_s()), CsvText(arl_low), CsvText(arl_high),
                           there ? fmt::to_string(one.detected) : "");
        const auto add = [&](const Estimate& estimate) {
          csv += fmt::format(",{},{},{}", CsvText(estimate.mean), CsvText(estimate.low),
                             CsvText(estimate.high));
        };
        add(one.detection);
        add(one.delay_s);
        csv += fmt::format(",{}", there ? CsvText(one.delay_if_detected_s) : "");
        for (const Estimate& e : {one.delay_minus_doc_s, one.auc, one.auc_minus_doc}) add(e);
        csv += "\n";
      }
    }
  }
  return csv;
}

std::string RocCsvOf(std::span<const ConflictSet> sets) {
  std::string csv =
      "fog,visibility_m,noise,measure,false_positives,true_positives,ci95_low,"
      "ci95_high\n";
  for (const ConflictSet& set : sets) {
    if (set.noise != kUsualNoise) continue;
    for (const ConflictOutcome& outcome : set.outcomes) {
      for (std::size_t m = 0; m < outcome.detectors.size(); ++m) {
        for (std::size_t i = 0; i < kFalsePositives.size(); ++i) {
          const Estimate& share = outcome.detectors[m].true_positives[i];
          csv += fmt::format("{},{},{},{},{:g},{},{},{}\n", set.fog, outcome.condition.visibility_m,
                             set.noise, NameOfMeasure(m), kFalsePositives[i], CsvText(share.mean),
                             CsvText(share.low), CsvText(share.high));
        }
      }
    }
  }
  return csv;
}

void AddPoint(report::StudySeries& series, double x, const Estimate& estimate) {
  series.x.push_back(x);
  series.y.push_back(estimate.mean);
  series.low.push_back(estimate.low);
  series.high.push_back(estimate.high);
}

/// Shows the Degree of Conflict, the three fastest measures, and the slowest one.
void ShowTelling(report::StudyFigure& figure, std::span<const std::size_t> ranked) {
  constexpr std::size_t kSoonest = 3;
  for (report::StudySeries& series : figure.series) series.shown = false;
  figure.series[0].shown = true;
  for (const std::size_t m : ranked.first(std::min(kSoonest, ranked.size()))) {
    figure.series[m].shown = true;
  }
  if (!ranked.empty()) figure.series[ranked.back()].shown = true;
}

/// A quantity of every measure as a function of the visibility.
report::StudyFigure OverVisibility(const ConflictSet& set, std::span<const std::size_t> ranked,
                                   std::string id, std::string title, std::string y_label,
                                   Estimate DetectorOutcome::*value) {
  report::StudyFigure figure{.id = std::move(id),
                             .title = std::move(title),
                             .caption =
                                 "Means over the seeds with 95 % confidence bands. Shown at first: "
                                 "the Degree of Conflict, the three soonest measures, the latest.",
                             .x_label = "Visibility (m)",
                             .y_label = std::move(y_label),
                             .log_x = true};
  for (std::size_t m = 0; m < conflict::ConflictMeasures().size(); ++m) {
    report::StudySeries& series = figure.series.emplace_back();
    series.name = NameOfMeasure(m);
    // The densest fog is last in a set and first on the axis.
    for (auto outcome = set.outcomes.rbegin(); outcome != set.outcomes.rend(); ++outcome) {
      AddPoint(series, outcome->condition.visibility_m, outcome->detectors[m].*value);
    }
  }
  ShowTelling(figure, ranked);
  return figure;
}

report::StudyFigure RocOf(const ConflictOutcome& outcome, std::span<const std::size_t> ranked,
                          std::string id) {
  report::StudyFigure figure{
      .id = std::move(id),
      .title = fmt::format("ROC: fog model {}, {:g} m, {} noise", outcome.condition.fog,
                           outcome.condition.visibility_m, outcome.condition.noise),
      .caption =
          "Step by step: share of steps in fog (level at least 1/2) that are above a "
          "threshold, against that of steps in clear air.",
      .x_label = "False positives (share of steps in clear air)",
      .y_label = "True positives (share of steps in fog)",
      .log_x = true};
  for (std::size_t m = 0; m < conflict::ConflictMeasures().size(); ++m) {
    report::StudySeries& series = figure.series.emplace_back();
    series.name = NameOfMeasure(m);
    for (std::size_t i = 0; i < kFalsePositives.size(); ++i) {
      AddPoint(series, kFalsePositives[i], outcome.detectors[m].true_positives[i]);
    }
  }
  ShowTelling(figure, ranked);
  return figure;
}

std::string MethodOf(const StudyContext& context) {
  return fmt::format(
      "scenario/paper.json, in which the human always drives (threshold 0), so that no measure "
      "affects the inputs of the others; {0} seeds of fog for each condition. Fog model bias has "
      "the bias of the scenario at {1:g} m of visibility. At other visibilities the bias is "
      "proportional to the extinction (our choice, because the model has no visibility). Fog model "
      "beam is the physics of the LiDAR's beam. Every measure knows the true mounting offset and "
      "counts a missing value as a conflict. Bins are as wide as the larger standard deviation of "
      "the two sensors. SPRT and CUSUM look for a shift of one standard deviation of the sensors' "
      "difference. So they are one test in two scales, and count as one. They can differ only if a "
      "bound cuts off the score of one of them. Threshold: the smallest one with a mean time to "
      "the first alarm of {2:g} s ({3:g} false alarms an hour) in {0} runs of {4:g} s in clear air "
      "with other seeds. A measure is not ranked if at this threshold it has no alarm, or a mean "
      "time more than {5:g} times as long. ARL0 is counted again in as many runs with other seeds. "
      "Delay from fog to alarm: time from the beginning of the fog to the first alarm in it. A fog "
      "without an alarm counts with its whole length of {6:g} s, so that no measure gains by "
      "missing a fog. It is not deception_to_alarm_s of a run. That time begins at the first step "
      "with a LiDAR error above its tolerance, is taken at the scenario's own threshold, and is 0 "
      "if there is already an alarm. Intervals of this delay and of detection: {7} resamples of "
      "the runs in clear air, each with its own threshold, and of the seeds of the fog. The "
      "resamples are the same for all measures and visibilities. So the intervals contain the "
      "uncertainty of the threshold, and differences are paired. Detection is given by visibility, "
      "with the interval of Clopper and Pearson if that is wider. AUC (Mann and Whitney): steps in "
      "fog of level at least 1/2 against every {8}th step in clear air. AUC and ROC are means over "
      "{9} batches of runs in fog, each against its own runs in clear air. Each interval holds by "
      "itself, not for all comparisons together.",
      context.seeds.count(), kReferenceVisibility_m, kArlZero_s, kHour_s / kArlZero_s, kClearRun_s,
      kLoosest, kFog_s, kReplicates, kClearStride, std::min(kBatches, context.seeds.count()));
}

}  // namespace

StudyResult RunConflictStudy(const StudyContext& context) {
  const std::vector<ConflictSet> sets = RunConflictSets(context);
  StudyResult result;
  result.runs = ConflictRuns(context);
  report::StudySection& section = result.section;
  std::vector<std::string> arl_zero;
  for (const ConflictSet& set : sets) {
    const std::vector<std::size_t> ranked = Rank(set);
    const std::vector<std::size_t> own = WithoutTwins(ranked);
    section.findings.push_back(FindingOf(set, own));
    section.tables.push_back(TableOf(set, ranked));
    arl_zero.push_back(FindingOfArlZero(set, own));
    if (set.noise != kUsualNoise) continue;
    section.figures.push_back(
        OverVisibility(set, ranked, fmt::format("conflict-delay-{}", set.fog),
                       fmt::format("Delay from fog to alarm: fog model {}", NameOfSet(set)),
                       "Fog to alarm (s)", &DetectorOutcome::delay_s));
    section.figures.push_back(
        OverVisibility(set, ranked, fmt::format("conflict-auc-{}", set.fog),
                       fmt::format("Area under the ROC: fog model {}", NameOfSet(set)), "AUC",
                       &DetectorOutcome::auc));
    section.figures.push_back(RocOf(set.outcomes[set.outcomes.size() / 2], ranked,
                                    fmt::format("conflict-roc-{}", set.fog)));
  }
  section.findings.push_back(
      fmt::format("Do thresholds keep an ARL0 of {:g} s in other runs in clear air? Number of "
                  "measures with a threshold whose 95 % interval of the ARL0 contains it: {}. A "
                  "threshold is an estimate, too, from as many runs. So even without any flaw, "
                  "more than one in twenty of these intervals would not contain it.",
                  kArlZero_s, fmt::join(arl_zero, "; ")));
  section.method = MethodOf(context);
  result.files = {{"conflict.csv", CsvOf(sets)}, {"conflict-roc.csv", RocCsvOf(sets)}};
  return result;
}

}  // namespace fogline::study
