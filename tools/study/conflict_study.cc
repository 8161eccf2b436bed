// Study `conflict`: every measure of conflict as a detector of fog, at an equal rate of false
// alarms.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "scenario/loader.h"
#include "services/conflict/measures.h"
#include "tools/study/conflict_runs.h"
#include "tools/study/study.h"

namespace fogline {
namespace {

constexpr double kHour_s = 3600;

/// Mean over the visibilities of a group of conditions, seed by seed.
std::vector<double> MeanOverVisibilities(std::span<const ConflictOutcome> group,
                                         std::size_t measure,
                                         std::vector<double> DetectorOutcome::*values) {
  const std::size_t seeds = (group.front().detectors[measure].*values).size();
  std::vector<double> means(seeds, 0.0);
  for (const ConflictOutcome& outcome : group) {
    for (std::size_t i = 0; i < seeds; ++i) {
      means[i] += (outcome.detectors[measure].*values)[i] / static_cast<double>(group.size());
    }
  }
  return means;
}

/// A measure in a group: one fog model and noise, all visibilities.
struct Ranked {
  std::size_t measure;
  Estimate delay;
  Estimate delay_minus_doc;
  Estimate auc;
  EventShare detected;
  AlarmCount clear;  // of runs that no threshold was calibrated on
};

std::vector<Ranked> Rank(std::span<const ConflictOutcome> group) {
  std::vector<Ranked> ranked;
  const std::vector<double> doc = MeanOverVisibilities(group, 0, &DetectorOutcome::delay_s);
  for (std::size_t m = 0; m < ConflictMeasures().size(); ++m) {
    const std::vector<double> delay = MeanOverVisibilities(group, m, &DetectorOutcome::delay_s);
    std::int64_t detected = 0;
    std::int64_t runs = 0;
    for (const ConflictOutcome& outcome : group) {
      detected += outcome.detectors[m].detected;
      runs += static_cast<std::int64_t>(outcome.detectors[m].delay_s.size());
    }
    ranked.push_back({.measure = m,
                      .delay = EstimateOf(delay),
                      .delay_minus_doc = PairedDifference(delay, doc),
                      .auc = EstimateOf(MeanOverVisibilities(group, m, &DetectorOutcome::auc)),
                      .detected = ClopperPearson(detected, runs),
                      .clear = group.front().detectors[m].clear});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.delay.mean < b.delay.mean; });
  return ranked;
}

std::string_view NameOfMeasure(std::size_t measure) { return ConflictMeasures()[measure].name; }

/// "a, b and c"; at most `most` of them by name.
std::string Listed(const std::vector<std::string_view>& names, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i];
  }
  if (names.size() > most) text += fmt::format(" and {} more", names.size() - most);
  return text;
}

std::string FindingOf(std::span<const ConflictOutcome> group, std::span<const Ranked> ranked) {
  std::vector<std::string_view> sooner;
  std::vector<std::string_view> later;
  std::size_t doc = 0;
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    if (ranked[i].measure == 0) doc = i;
    const Verdict verdict = VerdictOf(ranked[i].delay_minus_doc);
    if (verdict == Verdict::kLess) sooner.push_back(NameOfMeasure(ranked[i].measure));
    if (verdict == Verdict::kMore) later.push_back(NameOfMeasure(ranked[i].measure));
  }
  const Ranked& best = ranked.front();
  const ConflictCondition& condition = group.front().condition;
  std::string text = fmt::format(
      "Fog model {}, {} noise: {} is first with a mean delay of {} s; the Degree of Conflict needs "
      "{} s and is number {} of {}.",
      condition.fog, condition.noise, NameOfMeasure(best.measure), Text(best.delay, 2),
      Text(ranked[doc].delay, 2), doc + 1, ranked.size());
  const std::size_t undecided = ranked.size() - 1 - sooner.size() - later.size();
  text += sooner.empty() ? " No measure is sooner than it by more than chance."
                         : fmt::format(" {} of the others {} sooner ({}).", sooner.size(),
                                       sooner.size() == 1 ? "is" : "are", Listed(sooner, 6));
  if (!later.empty()) {
    text += fmt::format(" {} {} later ({}).", later.size(), later.size() == 1 ? "is" : "are",
                        Listed(later, 6));
  }
  if (undecided > 0) text += fmt::format(" {} cannot be told apart from it.", undecided);
  return text;
}

/// Whether a measure gives alarms as often in other runs in clear air as in those that its
/// threshold was found in: given the alarms of both, those of the former are binomial.
bool KeepsItsPromise(const DetectorOutcome& detector) {
  const AlarmCount& found = detector.calibrated;
  const AlarmCount& other = detector.clear;
  if (found.alarms + other.alarms == 0) return true;
  const EventShare share = ClopperPearson(other.alarms, found.alarms + other.alarms);
  const double expected = other.time_s / (found.time_s + other.time_s);
  return share.lower <= expected && expected <= share.upper;
}

/// How many thresholds keep what they promise in runs that they were not found in.
std::string FindingOfArlZero(std::span<const ConflictOutcome> group, const std::string& name) {
  const std::vector<DetectorOutcome>& detectors = group.front().detectors;
  return fmt::format("{}: {} of {}", name, std::ranges::count_if(detectors, KeepsItsPromise),
                     detectors.size());
}

StudyTable TableOf(const std::string& name, std::span<const Ranked> ranked) {
  StudyTable table{.caption = fmt::format("{}: mean over visibilities, soonest first", name),
                   .columns = {"measure", "delay (s)", "less or more than DoC (s)", "detected",
                               "AUC", "ARL0 in other clear runs (s)"}};
  for (const Ranked& one : ranked) {
    const auto [low, high] = one.clear.ArlZeroBounds_s();
    table.rows.push_back(
        {std::string(NameOfMeasure(one.measure)), Text(one.delay, 2), Text(one.delay_minus_doc, 2),
         fmt::format("{:.1f} % [{:.1f}, {:.1f}]", 100 * one.detected.share,
                     100 * one.detected.lower, 100 * one.detected.upper),
         Text(one.auc, 3),
         fmt::format("{} [{}, {}]", Text(one.clear.ArlZero_s(), 0), Text(low, 0), Text(high, 0))});
  }
  return table;
}

std::string CsvNumber(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

std::string CsvOf(std::span<const ConflictOutcome> outcomes) {
  std::string csv =
      "fog,visibility_m,noise,measure,n,threshold,calibrated_arl0_s,clear_alarms,arl0_s,"
      "arl0_ci95_low_s,arl0_ci95_high_s,detected,p_detected,p_ci95_low,p_ci95_high,delay_s,"
      "delay_ci95_low_s,delay_ci95_high_s,delay_if_detected_s,delay_minus_doc_s,"
      "delay_minus_doc_ci95_low_s,delay_minus_doc_ci95_high_s,auc,auc_ci95_low,auc_ci95_high,"
      "auc_minus_doc,auc_minus_doc_ci95_low,auc_minus_doc_ci95_high\n";
  for (const ConflictOutcome& outcome : outcomes) {
    const DetectorOutcome& doc = outcome.detectors.front();
    for (std::size_t m = 0; m < outcome.detectors.size(); ++m) {
      const DetectorOutcome& one = outcome.detectors[m];
      const auto n = static_cast<std::int64_t>(one.delay_s.size());
      const EventShare share = ClopperPearson(one.detected, n);
      const Estimate delay = EstimateOf(one.delay_s);
      const Estimate auc = EstimateOf(one.auc);
      const Estimate delay_minus_doc = PairedDifference(one.delay_s, doc.delay_s);
      const Estimate auc_minus_doc = PairedDifference(one.auc, doc.auc);
      const auto [arl_low, arl_high] = one.clear.ArlZeroBounds_s();
      csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}", outcome.condition.fog,
                         outcome.condition.visibility_m, outcome.condition.noise, NameOfMeasure(m),
                         n, CsvNumber(one.threshold), CsvNumber(one.calibrated.ArlZero_s()),
                         one.clear.alarms, CsvNumber(one.clear.ArlZero_s()), CsvNumber(arl_low),
                         CsvNumber(arl_high), one.detected);
      for (const double value :
           {share.share, share.lower, share.upper, delay.mean, delay.low, delay.high,
            one.delay_if_detected_s, delay_minus_doc.mean, delay_minus_doc.low,
            delay_minus_doc.high, auc.mean, auc.low, auc.high, auc_minus_doc.mean,
            auc_minus_doc.low, auc_minus_doc.high}) {
        csv += fmt::format(",{}", CsvNumber(value));
      }
      csv += "\n";
    }
  }
  return csv;
}

std::string RocCsvOf(std::span<const ConflictOutcome> outcomes) {
  std::string csv =
      "fog,visibility_m,noise,measure,false_positives,true_positives,ci95_low,"
      "ci95_high\n";
  for (const ConflictOutcome& outcome : outcomes) {
    if (outcome.condition.noise != kUsualNoise) continue;
    for (std::size_t m = 0; m < outcome.detectors.size(); ++m) {
      for (std::size_t i = 0; i < kFalsePositives.size(); ++i) {
        const Estimate share = EstimateOf(outcome.detectors[m].true_positives[i]);
        csv += fmt::format("{},{},{},{},{:g},{:.4f},{:.4f},{:.4f}\n", outcome.condition.fog,
                           outcome.condition.visibility_m, outcome.condition.noise,
                           NameOfMeasure(m), kFalsePositives[i], share.mean, share.low, share.high);
      }
    }
  }
  return csv;
}

void AddPoint(StudySeries& series, double x, const Estimate& estimate) {
  series.x.push_back(x);
  series.y.push_back(estimate.mean);
  series.low.push_back(estimate.low);
  series.high.push_back(estimate.high);
}

/// Shows the Degree of Conflict, the three soonest, and the latest.
void ShowTelling(StudyFigure& figure, std::span<const Ranked> ranked) {
  constexpr std::size_t kSoonest = 3;
  for (StudySeries& series : figure.series) series.shown = false;
  figure.series[0].shown = true;
  for (std::size_t i = 0; i < kSoonest; ++i) figure.series[ranked[i].measure].shown = true;
  figure.series[ranked.back().measure].shown = true;
}

/// A quantity of every measure over the visibility.
StudyFigure OverVisibility(std::span<const ConflictOutcome> group, std::span<const Ranked> ranked,
                           std::string id, std::string title, std::string y_label,
                           std::vector<double> DetectorOutcome::*values) {
  StudyFigure figure{.id = std::move(id),
                     .title = std::move(title),
                     .caption =
                         "Means over the seeds with 95 % confidence bands. Shown at first: "
                         "the Degree of Conflict, the three soonest measures, the latest.",
                     .x_label = "Visibility (m)",
                     .y_label = std::move(y_label),
                     .log_x = true};
  for (std::size_t m = 0; m < ConflictMeasures().size(); ++m) {
    StudySeries& series = figure.series.emplace_back();
    series.name = NameOfMeasure(m);
    // The densest fog comes last in a group, and first on the axis.
    for (auto outcome = group.rbegin(); outcome != group.rend(); ++outcome) {
      AddPoint(series, outcome->condition.visibility_m, EstimateOf(outcome->detectors[m].*values));
    }
  }
  ShowTelling(figure, ranked);
  return figure;
}

StudyFigure RocOf(const ConflictOutcome& outcome, std::span<const Ranked> ranked, std::string id) {
  StudyFigure figure{
      .id = std::move(id),
      .title = fmt::format("ROC: fog model {}, {:g} m, {} noise", outcome.condition.fog,
                           outcome.condition.visibility_m, outcome.condition.noise),
      .caption =
          "Step by step: share of steps in fog (level at least 1/2) that are above a "
          "threshold, against that of steps in clear air.",
      .x_label = "False positives (share of steps in clear air)",
      .y_label = "True positives (share of steps in fog)",
      .log_x = true};
  for (std::size_t m = 0; m < ConflictMeasures().size(); ++m) {
    StudySeries& series = figure.series.emplace_back();
    series.name = NameOfMeasure(m);
    for (std::size_t i = 0; i < kFalsePositives.size(); ++i) {
      AddPoint(series, kFalsePositives[i], EstimateOf(outcome.detectors[m].true_positives[i]));
    }
  }
  ShowTelling(figure, ranked);
  return figure;
}

std::string MethodOf(const StudyContext& context) {
  return fmt::format(
      "scenario/paper.json with the human at the wheel throughout (threshold 0), so that no "
      "measure "
      "changes what the next one sees; {} seeds of fog for each condition. Fog model bias has the "
      "bias of the scenario at {:g} m of visibility and in proportion to the extinction else (our "
      "choice: the model itself knows no visibility); model beam is the physics of the LiDAR's "
      "beam. Every measure is told the true mounting offset and takes a missing value for a "
      "conflict. Thresholds: the least with a mean time to the first alarm of {:g} s ({:g} false "
      "alarms an hour) in {} runs of {:g} s in clear air with other seeds; ARL0 is then counted "
      "in as many runs again, of other seeds. Delay: from the begin of the fog to the first alarm "
      "within it; a fog that is never noticed counts with its whole length of {:g} s, so that no "
      "measure gains by missing what is hard to see. AUC: Mann and Whitney, steps in fog of level "
      "at least 1/2 against every {}th step in clear air, by seed. All measures see the same "
      "seeds; differences are paired. Intervals hold one by one, not for all comparisons at once.",
      context.seeds.count(), kReferenceVisibility_m, kArlZero_s, kHour_s / kArlZero_s,
      context.seeds.count(), kClearRun_s, kFog_s, kClearStride);
}

}  // namespace

StudyResult RunConflictStudy(const StudyContext& context) {
  const std::vector<ConflictOutcome> outcomes = RunConflictConditions(context);
  StudyResult result;
  result.runs = ConflictRuns(context);
  StudySection& section = result.section;
  std::vector<std::string> arl_zero;
  constexpr std::size_t kGroup = kVisibilities_m.size();
  for (std::size_t first = 0; first < outcomes.size(); first += kGroup) {
    const std::span group = std::span(outcomes).subspan(first, kGroup);
    const ConflictCondition& condition = group.front().condition;
    const std::vector<Ranked> ranked = Rank(group);
    const std::string name = fmt::format("{}, {} noise", condition.fog, condition.noise);
    section.findings.push_back(FindingOf(group, ranked));
    section.tables.push_back(TableOf("Fog model " + name, ranked));
    arl_zero.push_back(FindingOfArlZero(group, name));
    if (condition.noise != kUsualNoise) continue;
    section.figures.push_back(OverVisibility(group, ranked,
                                             fmt::format("conflict-delay-{}", condition.fog),
                                             fmt::format("Delay of detection: fog model {}", name),
                                             "Delay (s)", &DetectorOutcome::delay_s));
    section.figures.push_back(OverVisibility(
        group, ranked, fmt::format("conflict-auc-{}", condition.fog),
        fmt::format("Area under the ROC: fog model {}", name), "AUC", &DetectorOutcome::auc));
    section.figures.push_back(
        RocOf(group[kGroup / 2], ranked, fmt::format("conflict-roc-{}", condition.fog)));
  }
  section.findings.push_back(
      fmt::format("Do thresholds keep their promise of an ARL0 of {:g} s in clear air that they "
                  "were not found in? So many measures give alarms as often there as where they "
                  "were calibrated, as far as 95 % bounds can tell: {}.",
                  kArlZero_s, fmt::join(arl_zero, "; ")));
  section.method = MethodOf(context);
  result.files = {{"conflict.csv", CsvOf(outcomes)}, {"conflict-roc.csv", RocCsvOf(outcomes)}};
  return result;
}

}  // namespace fogline
