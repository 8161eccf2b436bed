// Study `conflict`: compares every measure of conflict as a detector of fog, at an equal rate of
// false alarms.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "services/decision/conflict/conflict_measures.h"
#include "tools/study/bootstrap.h"
#include "tools/study/claims.h"
#include "tools/study/detection/conflict_runs.h"
#include "tools/study/study.h"

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

constexpr std::string_view kConflictAnswer =
    "Those that look at several steps at once and know in which direction fog deceives the LiDAR. "
    "The paper's Degree of Conflict is one of them, and its formula adds nothing to that: the "
    "signed "
    "normalised innovation alarms in the same steps. Where fog makes a false echo, nearly all "
    "measures are equally fast.";
constexpr std::string_view kConflictWouldChange =
    "A deception that grows slowly, or sensors whose noise is not white.";

/// Index of a measure. @throws std::out_of_range
std::size_t MeasureNamed(std::string_view name) {
  const auto rows = conflict::ConflictMeasures();
  const auto found = std::ranges::find(rows, name, &conflict::ConflictMeasureRow::name);
  if (found == rows.end()) throw std::out_of_range(fmt::format("no measure {}", name));
  return static_cast<std::size_t>(found - rows.begin());
}

/// The claim on a measure's mean delay against that of the Degree of Conflict.
Claim AgainstDoc(const ConflictSet& set, std::string says, std::string_view measure, Sign sign,
                 double margin = 0) {
  const std::size_t m = MeasureNamed(measure);
  const bool ranked = set.thresholds[m].is_determined() && set.thresholds[0].is_determined();
  return {.says = std::move(says),
          .compared = fmt::format("{}: {} against doc, delay from fog to alarm (s)", NameOfSet(set),
                                  measure),
          .sign = sign,
          .difference = set.means[m].delay_minus_doc_s,
          .margin = margin,
          .p = {},
          .hindrance = ranked ? "" : "no threshold for this rate of false alarms"};
}

std::vector<Claim> ConflictClaims(std::span<const ConflictSet> sets) {
  constexpr double kStep_s = 0.1;
  std::vector<Claim> claims;
  for (const ConflictSet& set : sets) {
    if (set.noise != kUsualNoise) continue;
    if (set.fog == "beam") {
      claims.push_back(AgainstDoc(set, "In beam fog a window makes no difference.", "nis",
                                  Sign::kEqual, kStep_s));
      continue;
    }
    claims.push_back(AgainstDoc(set, "A measure of a single step is slower.", "nis", Sign::kMore));
    claims.push_back(
        AgainstDoc(set, "A window without the known sign is slower.", "nis_window", Sign::kMore));
    claims.push_back(AgainstDoc(set, "A window with the known sign is as fast.", "nis_signed",
                                Sign::kEqual, kStep_s));
    claims.push_back(AgainstDoc(set, "A sum over all steps is faster.", "cusum", Sign::kLess));
  }
  return claims;
}

std::string ArlText(const AlarmCount& clear) {
  const auto [low, high] = clear.ArlZeroBounds_s();
  return fmt::format("{} [{}, {}]", Text(clear.ArlZero_s(), 0), Text(low, 0), Text(high, 0));
}

std::string PercentText(const Estimate& share) {
  Estimate percent = share;
  for (double* value : {&percent.mean, &percent.low, &percent.high}) *value *= 100;
  return Text(percent, 0);
}

report::StudyTable TableOfSet(const ConflictSet& set, std::span<const std::size_t> ranked) {
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

/// Mean delays of some measures in every set.
report::StudyTable ConflictMainTable(std::span<const ConflictSet> sets) {
  report::StudyTable table{
      .caption = "Delay from fog to alarm (s), mean over visibilities [95 % confidence interval]",
      .columns = {"measure"}};
  for (const ConflictSet& set : sets) table.columns.push_back(NameOfSet(set));
  for (const std::string_view name :
       {"doc", "nis", "nis_window", "nis_signed", "cusum", "glr", "lidar_modes"}) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.emplace_back(name);
    const std::size_t m = MeasureNamed(name);
    for (const ConflictSet& set : sets) {
      row.push_back(set.thresholds[m].is_determined() ? Text(set.means[m].delay_s, 2)
                                                      : "no threshold");
    }
  }
  return table;
}

std::string ConflictCsv(std::span<const ConflictSet> sets) {
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

std::string RocCsv(std::span<const ConflictSet> sets) {
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

std::string ConflictMethod(const StudyContext& context) {
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
  for (const ConflictSet& set : sets) {
    const std::vector<std::size_t> ranked = Rank(set);
    section.tables.push_back(TableOfSet(set, ranked));
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
  section.answer = kConflictAnswer;
  section.would_change = kConflictWouldChange;
  result.claims = ConflictClaims(sets);
  section.tables.insert(section.tables.begin(), ConflictMainTable(sets));
  section.method = ConflictMethod(context);
  result.files = {{"conflict.csv", ConflictCsv(sets)}, {"conflict-roc.csv", RocCsv(sets)}};
  return result;
}

}  // namespace fogline::study
