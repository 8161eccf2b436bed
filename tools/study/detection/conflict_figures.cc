#include <algorithm>

#include <fmt/format.h>

#include "tools/study/comparison.h"
#include "tools/study/detection/conflict_tables.h"

namespace fogline::study {
namespace {

/// Selects the series that the page shows at first: the Degree of Conflict, the three measures with
/// the shortest delays, and the measure with the longest delay.
void ShowTelling(report::StudyFigure& figure, const ConflictSet& set) {
  constexpr std::size_t kSoonest = 3;
  std::vector<std::size_t> ranked = Ranked(set);
  std::erase_if(ranked, [&](std::size_t d) { return d >= figure.series.size(); });
  for (report::StudySeries& series : figure.series) series.shown = false;
  figure.series[0].shown = true;
  for (const std::size_t m : std::span(ranked).first(std::min(kSoonest, ranked.size()))) {
    figure.series[m].shown = true;
  }
  if (!ranked.empty()) figure.series[ranked.back()].shown = true;
}

/// A figure of one quantity (`value`) as a function of the visibility, with a series for each
/// measure.
report::StudyFigure OverVisibility(const ConflictSet& set, std::string id, std::string title,
                                   std::string y_label, Estimate DetectorOutcome::*value) {
  report::StudyFigure figure{.id = std::move(id),
                             .title = std::move(title),
                             .caption =
                                 "Means over the seeds with 95 % confidence bands. Shown at first: "
                                 "the Degree of Conflict, the three soonest measures, the latest.",
                             .x_label = "Visibility (m)",
                             .y_label = std::move(y_label),
                             .log_x = true};
  for (std::size_t m = 0; m < ComparedMeasures().size(); ++m) {
    report::StudySeries& series = figure.series.emplace_back();
    series.name = Detectors()[m].name;
    // The outcomes of a set end with the densest fog, but the axis begins with it.
    for (auto outcome = set.outcomes.rbegin(); outcome != set.outcomes.rend(); ++outcome) {
      AddPoint(series, outcome->condition.visibility_m, outcome->detectors[m].*value);
    }
  }
  ShowTelling(figure, set);
  return figure;
}

report::StudyFigure RocOf(const ConflictSet& set, const ConflictOutcome& outcome) {
  report::StudyFigure figure{
      .id = fmt::format("conflict-roc-{}", set.fog),
      .title = fmt::format("ROC: fog model {}, {:g} m, {} noise", outcome.condition.fog,
                           outcome.condition.visibility_m, outcome.condition.noise),
      .caption =
          "Step by step: share of steps in fog (level at least 1/2) that are above a "
          "threshold, against that of steps in clear air.",
      .x_label = "False positives (share of steps in clear air)",
      .y_label = "True positives (share of steps in fog)",
      .log_x = true};
  for (std::size_t m = 0; m < ComparedMeasures().size(); ++m) {
    report::StudySeries& series = figure.series.emplace_back();
    series.name = Detectors()[m].name;
    for (std::size_t i = 0; i < kFalsePositives.size(); ++i) {
      AddPoint(series, kFalsePositives[i], outcome.detectors[m].true_positives[i]);
    }
  }
  ShowTelling(figure, set);
  return figure;
}

}  // namespace

std::vector<report::StudyFigure> FiguresOf(const ConflictSet& set) {
  return {OverVisibility(set, fmt::format("conflict-delay-{}", set.fog),
                         fmt::format("Delay from fog to alarm: fog model {}", NameOfSet(set)),
                         "Fog to alarm (s)", &DetectorOutcome::delay_s),
          OverVisibility(set, fmt::format("conflict-auc-{}", set.fog),
                         fmt::format("Area under the ROC: fog model {}", NameOfSet(set)), "AUC",
                         &DetectorOutcome::auc),
          RocOf(set, set.outcomes[set.outcomes.size() / 2])};
}

}  // namespace fogline::study
