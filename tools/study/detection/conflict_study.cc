// Study `conflict`: compares every measure of conflict as a detector of fog, at an equal rate of
// false alarms. It also finds which parts of the Degree of Conflict (window, sign, sigmoid) make it
// better than the other measures.
#include <algorithm>

#include <fmt/format.h>

#include "tools/study/bootstrap.h"
#include "tools/study/claims.h"
#include "tools/study/delays/delay_claims.h"
#include "tools/study/detection/conflict_tables.h"
#include "tools/study/detection/runs/clear_air.h"
#include "tools/study/sensor_noise.h"
#include "tools/study/study.h"

namespace fogline::study {
namespace {

constexpr double kHour_s = 3600;

constexpr std::string_view kConflictAnswer =
    "Measures that use several steps, and know the direction in which fog deceives the LiDAR, "
    "notice fog first. The lead of the paper's Degree of Conflict comes from its window (a mean "
    "over several steps) and from its known sign (this direction); its sigmoid changes no alarm by "
    "definition, because it rises with the difference of the ranges. Where fog makes a false echo, "
    "several measures of a single step are just as fast.";
constexpr std::string_view kConflictWouldChange =
    "A deception that grows slowly, or sensors whose noise is not white.";

std::vector<Claim> ConflictClaims(std::span<const ConflictSet> sets) {
  std::vector<Claim> claims;
  for (const ConflictSet& set : sets) {
    if (set.fog != "bias" || (set.noise != kUsualNoise && set.noise != "realistic")) continue;
    for (const DelayStatement& statement : DelayStatements()) {
      const std::size_t a = DetectorNamed(statement.a);
      const std::size_t b = DetectorNamed(statement.b);
      const bool compared = set.IsCompared(a) && set.IsCompared(b);
      claims.push_back({.says = SaysOf(statement, set.noise),
                        .compared = fmt::format("{}: {} against {}, delay from fog to alarm (s)",
                                                NameOfSet(set), statement.a, statement.b),
                        .sign = statement.sign,
                        .difference = set.Difference(a, b),
                        .margin = statement.margin,
                        .p = {},
                        .hindrance = !set.Ranks() ? "no condition ranks detectors"
                                     : compared   ? ""
                                                  : "no threshold for this rate of false alarms"});
    }
  }
  return claims;
}

/// The conditions for which TellingOf() has this result, such as "beam, near-range noise (75 m, 50
/// m)".
std::string ConditionsText(std::span<const ConflictSet> sets, Telling telling) {
  std::string text;
  for (const ConflictSet& set : sets) {
    std::string visibilities;
    for (const ConflictOutcome& outcome : set.outcomes) {
      if (outcome.telling != telling) continue;
      visibilities +=
          fmt::format("{}{:g} m", visibilities.empty() ? "" : ", ", outcome.condition.visibility_m);
    }
    if (visibilities.empty()) continue;
    text += fmt::format("{}{} ({})", text.empty() ? "" : "; ", NameOfSet(set), visibilities);
  }
  return text.empty() ? "none" : text;
}

std::string ConflictMethod(const StudyContext& context, std::span<const ConflictSet> sets) {
  std::size_t fewest = Detectors().size();
  for (const ConflictSet& set : sets) {
    if (set.Ranks()) fewest = std::min(fewest, Ranked(set).size());
  }
  return fmt::format(
      "scenario/paper.json, in which the human always drives (threshold 0), so that no measure "
      "affects the inputs of the others; {0} seeds of fog for each condition (a fog model, a "
      "visibility and a noise). This human sees the truth, so the traffic does not depend on the "
      "sensors: it is computed once, and only sensors, filter and measures run for each seed. Fog "
      "model bias has the bias of the scenario at {1:g} m of visibility. At other visibilities the "
      "bias is proportional to the extinction (our choice, because the model has no visibility). "
      "Fog model beam is the physics of the LiDAR's beam. Noise of the radar's range: 0.01 m as in "
      "the scenario (calibrated), and 0.1 m (near-range), {2} m (realistic) and 0.4 m (far-range) "
      "of a data sheet. Every measure knows the true mounting offset and counts a missing value as "
      "a conflict. The measures with bins of distance have bins as wide as the larger standard "
      "deviation of the two sensors. SPRT and CUSUM look for a shift of one standard deviation of "
      "the sensors' difference. Options: each measure of a single step also takes part with the "
      "window of the Degree of Conflict (the mean of its scores), with a known sign (its score is "
      "negative if the LiDAR's range is too long), and with both. Distance is the absolute "
      "difference of the ranges; with window, sign and sigmoid it is the Degree of Conflict. The "
      "sigmoid rises with the distance that has window and sign. So each threshold of this "
      "distance corresponds to one threshold of the Degree of Conflict, and both have equal alarms "
      "by definition; the runs only check the program. Detectors with the same alarms in all runs "
      "count as one, with all their names. Of the {3} detectors, each ranking has at least {4} "
      "different ones. Threshold: the smallest one with a mean time to the first alarm (ARL0) of "
      "at least {5:g} s ({6:g} false alarms an hour) in runs of {7:g} s in clear air with other "
      "seeds. Detectors that are quick to compute have {8} such runs for each of the {0} seeds. "
      "The others, which add up bins or intervals or compare three ranges, have {10}. For each "
      "threshold, the CSV file has the number of alarms in the runs from which the threshold was "
      "computed, and the ARL0 of these alarms with its exact interval. The ARL0 is measured again "
      "in {0} other runs. A detector is not ranked if at its threshold it has no alarm, or if its "
      "mean time to the first alarm is more than {9:g} times the required {5:g} s. ",
      context.seeds.count(), kReferenceVisibility_m, kRealisticNoise_m, Detectors().size(), fewest,
      kArlZero_s, kHour_s / kArlZero_s, kClearRun_s, kQuickClearAir, kLoosest, kSlowClearAir);
}

std::string DelayMethod(const StudyContext& context, std::span<const ConflictSet> sets) {
  return fmt::format(
      "Delay from fog to alarm: time from the beginning of the fog to the first alarm in this fog. "
      "A fog without an alarm counts with its whole length of {0:g} s, so that no measure gains by "
      "missing a fog. This delay is not deception_to_alarm_s of a run. That time begins at the "
      "first step in which the LiDAR's error is above measures.lidar_tolerance_m, and ends when "
      "the Degree of Conflict reaches the scenario's own threshold. It is 0 if there is already an "
      "alarm. A condition does not rank detectors in two cases. First case, \"all raise the alarm "
      "at once\": the mean delays of nine of ten detectors lie within one window of the Degree of "
      "Conflict. Second case, \"hardly any alarm\": every detector finds less than a tenth of the "
      "fogs. Such conditions are in no mean and in no claim. All raise the alarm at once: {4}. "
      "Hardly any alarm: {5}. Intervals of this delay and of detection: {1} resamples of the runs "
      "in clear air, each with its own threshold, and of the seeds of the fog. The resamples are "
      "the same for all visibilities, and for all detectors with equally many runs. So the "
      "intervals contain the uncertainty of the threshold, and differences are paired. Detection "
      "is the share of the fogs that a detector finds at a visibility; its interval contains the "
      "interval of the resamples and that of Clopper and Pearson. AUC (area under the ROC curve, "
      "by Mann and Whitney): steps in fog of level at least 1/2 against every {2}th step in clear "
      "air. AUC and ROC are means over {3} batches of runs in fog, each against its own runs in "
      "clear air. Each interval is for a single comparison.",
      kFog_s, kReplicates, kClearStride, std::min(kBatches, context.seeds.count()),
      ConditionsText(sets, Telling::kAllAtOnce), ConditionsText(sets, Telling::kHardlyAny));
}

}  // namespace

StudyResult RunConflictStudy(const StudyContext& context) {
  const std::vector<ConflictSet> sets = RunConflictSets(context);
  StudyResult result;
  report::StudySection& section = result.section;
  section.answer = kConflictAnswer;
  section.would_change = kConflictWouldChange;
  section.tables = {TableOfParts(sets), TableOfConditions(sets)};
  for (const ConflictSet& set : sets) {
    result.runs += set.runs;
    if (set.Ranks()) section.tables.push_back(TableOfOptions(set));
    section.tables.push_back(TableOfDetectors(set));
    if (set.noise != kUsualNoise) continue;
    for (report::StudyFigure& figure : FiguresOf(set)) {
      section.figures.push_back(std::move(figure));
    }
  }
  result.claims = ConflictClaims(sets);
  section.method = ConflictMethod(context, sets) + DelayMethod(context, sets);
  result.files = {{"conflict.csv", ConflictCsv(sets)}, {"conflict-roc.csv", RocCsv(sets)}};
  return result;
}

}  // namespace fogline::study
