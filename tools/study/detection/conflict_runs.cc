#include "tools/study/detection/conflict_runs.h"

#include <algorithm>
#include <utility>

#include "tools/study/detection/runs/fog_runs.h"

namespace fogline::study {
namespace {

constexpr std::array<std::string_view, 2> kFogModels{"bias", "beam"};

/// Runs in clear air, by detector.
using ClearRuns = std::vector<std::vector<ClearRun>>;

/// All runs of a ConflictSet.
struct SetRuns {
  ClearRuns calibration;  // runs from which thresholds are found
  ClearRuns validation;   // other runs, in which false alarms are counted again
  ClearRuns further_air;  // used instead of `calibration` if ConflictSet::Ranks() is true
  std::vector<std::vector<std::vector<ScoreRecords>>> fog;  // by detector, visibility, seed

  /// The runs from which the threshold of a detector is found.
  std::span<const ClearRun> OfThreshold(std::size_t detector) const {
    return further_air[detector].empty() ? calibration[detector] : further_air[detector];
  }
};

SetRuns RunFirstClearAir(const StudyContext& context, const Traffic& clear_air,
                         const ShowUnit& show) {
  ClearAirPlan plan{.detectors = AllDetectors(),
                    .first_seed = kCalibrationSeeds + context.seeds.first};
  SetRuns runs;
  runs.calibration = RunClearAir(context, clear_air, plan, show);
  plan.first_seed = kValidationSeeds + context.seeds.first;
  plan.keeps_scores = true;
  runs.validation = RunClearAir(context, clear_air, plan, show);
  runs.further_air.resize(Detectors().size());
  runs.fog.resize(Detectors().size());
  return runs;
}

/// Makes further runs in clear air for some detectors. @param plan without its first seed, which
/// this function sets
void RunFurtherClearAir(const StudyContext& context, const Traffic& clear_air, ClearAirPlan plan,
                        const ShowUnit& show, SetRuns& runs) {
  plan.first_seed = kFurtherClearAirSeeds + plan.runs_per_seed * context.seeds.first;
  ClearRuns of_plan = RunClearAir(context, clear_air, plan, show);
  for (std::size_t i = 0; i < of_plan.size(); ++i) {
    runs.further_air[plan.detectors[i]] = std::move(of_plan[i]);
  }
}

/// Adds AUC and ROC of every detector to the outcome of a condition. AUC and ROC need no threshold.
void AddRoc(std::span<const Gathered> gathered, ConflictOutcome& outcome) {
  const std::vector<double> doc = gathered.front().auc.Result();
  for (const Gathered& one : gathered) {
    DetectorOutcome& detector = outcome.detectors.emplace_back();
    const std::vector<double> auc = one.auc.Result();
    detector.auc = EstimateOf(auc);
    detector.auc_minus_doc = PairedDifference(auc, doc);
    for (std::size_t i = 0; i < kFalsePositives.size(); ++i) {
      detector.true_positives[i] = EstimateOf(one.true_positives[i].Result());
    }
  }
}

/// Makes the runs in fog of every visibility, and adds all results that need no threshold.
void RunFogs(const StudyContext& context, const ConflictSituation& situation, const ShowUnit& show,
             SetRuns& runs, ConflictSet& set) {
  const std::vector<SortedBatches> clear_scores = SortScores(runs.validation);
  // Means of the AUC over the visibilities, by detector and batch of runs (kBatches).
  std::vector<std::vector<double>> auc(clear_scores.size(),
                                       std::vector<double>(clear_scores.front().size(), 0.0));
  for (const double visibility_m : kVisibilities_m) {
    const Traffic traffic = TrafficOf(ScenarioInFog(context, situation, visibility_m));
    std::vector<Gathered> gathered = RunInFog(context, traffic, clear_scores, show);
    ConflictOutcome& outcome = set.outcomes.emplace_back();
    outcome.condition = {.fog = set.fog, .noise = set.noise, .visibility_m = visibility_m};
    AddRoc(gathered, outcome);
    for (std::size_t d = 0; d < gathered.size(); ++d) {
      runs.fog[d].push_back(std::move(gathered[d].records));
      const std::vector<double> batches = gathered[d].auc.Result();
      for (std::size_t i = 0; i < batches.size(); ++i) {
        auc[d][i] += batches[i] / static_cast<double>(kVisibilities_m.size());
      }
    }
  }
  for (const std::vector<double>& means : auc) set.auc.push_back(EstimateOf(means));
  set.runs += static_cast<std::int64_t>(kVisibilities_m.size()) * set.seeds;
}

void SetThresholds(const SetRuns& runs, ConflictSet& set) {
  set.thresholds.clear();
  for (std::size_t d = 0; d < Detectors().size(); ++d) {
    const std::span<const ClearRun> from = runs.OfThreshold(d);
    const double threshold = ThresholdFinder(from).Threshold(kArlZero_s);
    set.thresholds.push_back({.threshold = threshold,
                              .calibrated = CountAlarms(from, threshold),
                              .clear = CountAlarms(runs.validation[d], threshold)});
  }
}

void AddAlarms(std::span<const ClearRun> runs, double threshold, std::vector<double>& times_s) {
  for (const ClearRun& run : runs) {
    times_s.push_back(FirstAlarm(run.records, threshold).value_or(-1));
  }
}

/// The first alarms of each detector in those runs that all detectors have.
std::vector<AlarmTimes> CommonAlarms(const SetRuns& runs, const ConflictSet& set) {
  std::vector<AlarmTimes> alarms(Detectors().size());
  for (std::size_t d = 0; d < alarms.size(); ++d) {
    const double threshold = set.thresholds[d].threshold;
    std::vector<double>& times_s = alarms[d].common;
    AddAlarms(runs.calibration[d], threshold, times_s);
    AddAlarms(runs.validation[d], threshold, times_s);
    for (const std::vector<ScoreRecords>& seeds : runs.fog[d]) {
      for (const ScoreRecords& records : seeds) {
        times_s.push_back(FirstAlarm(records, threshold).value_or(-1));
      }
    }
  }
  return alarms;
}

/// The value of ConflictSet::counts_as. Detectors without a threshold count as themselves.
std::vector<std::size_t> CountsAs(const ConflictSet& set, std::span<const AlarmTimes> alarms) {
  std::vector<std::size_t> counts_as = AllDetectors();
  std::vector<std::size_t> compared;
  std::vector<AlarmTimes> of_compared;
  for (std::size_t d = 0; d < alarms.size(); ++d) {
    if (!set.IsCompared(d)) continue;
    compared.push_back(d);
    of_compared.push_back(alarms[d]);
  }
  const std::vector<std::size_t> one_of = OneOfEqualAlarms(of_compared);
  for (std::size_t i = 0; i < compared.size(); ++i) counts_as[compared[i]] = compared[one_of[i]];
  return counts_as;
}

/// The detectors that have a threshold. Of several detectors with the same alarms, the result has
/// only one.
std::vector<std::size_t> DistinctOf(const ConflictSet& set) {
  std::vector<std::size_t> distinct;
  for (std::size_t d = 0; d < set.thresholds.size(); ++d) {
    if (set.IsCompared(d) && set.counts_as[d] == d) distinct.push_back(d);
  }
  return distinct;
}

/// Sets the number and the mean delay of the alarms in the fog of one visibility.
void AddDetected(std::span<const ScoreRecords> records, double threshold,
                 DetectorOutcome& detector) {
  detector.detected = 0;
  detector.delay_if_detected_s = 0;
  for (const ScoreRecords& one : records) {
    const std::optional<double> alarm = FirstAlarm(one, threshold);
    if (!alarm) continue;
    ++detector.detected;
    detector.delay_if_detected_s += *alarm;
  }
  detector.delay_if_detected_s /= static_cast<double>(detector.detected);
}

/// Sets for each condition whether its results can rank the detectors (Telling). Uses the
/// thresholds that `set` has now.
void SetTelling(const StudyContext& context, const SetRuns& runs, ConflictSet& set) {
  const Scenario paper = context.Load("paper.json", {});
  const double window_s = static_cast<double>(paper.arbitrator.window_steps) * paper.step_s;
  for (std::size_t v = 0; v < set.outcomes.size(); ++v) {
    std::vector<DelayAndShare> found;
    for (const std::size_t d : DistinctOf(set)) {
      DetectorOutcome one;
      AddDetected(runs.fog[d][v], set.thresholds[d].threshold, one);
      const auto seeds = static_cast<double>(set.seeds);
      const auto detected = static_cast<double>(one.detected);
      const double alarms_s = one.detected > 0 ? detected * one.delay_if_detected_s : 0;
      found.push_back(
          {.delay_s = (alarms_s + (seeds - detected) * kFog_s) / seeds, .share = detected / seeds});
    }
    set.outcomes[v].telling = TellingOf(found, window_s);
  }
}

/// Adds the results that need a threshold.
void AddDetection(const StudyContext& context, const SetRuns& runs, ConflictSet& set) {
  const std::vector<std::size_t> distinct = DistinctOf(set);
  DetectionRule rule{
      .arl_zero_s = kArlZero_s, .missed_s = kFog_s, .ranked = {}, .jobs = context.jobs};
  for (std::size_t v = 0; v < set.outcomes.size(); ++v) {
    if (set.outcomes[v].telling == Telling::kRanks) rule.ranked.push_back(v);
  }
  std::vector<DetectorRuns> of_distinct;
  for (const std::size_t d : distinct) {
    of_distinct.push_back({.clear = runs.OfThreshold(d), .fog = runs.fog[d]});
  }
  if (set.IsCompared(0)) rule.reference = 0;  // the Degree of Conflict
  const std::vector<DetectionComparison> compared = CompareDetection(of_distinct, rule);
  set.compared.resize(set.thresholds.size());
  for (std::size_t d = 0; d < set.thresholds.size(); ++d) {
    if (!set.IsCompared(d)) continue;
    const auto one = std::ranges::find(distinct, set.counts_as[d]);
    set.compared[d] = compared[static_cast<std::size_t>(one - distinct.begin())];
    for (std::size_t v = 0; v < set.outcomes.size(); ++v) {
      DetectorOutcome& detector = set.outcomes[v].detectors[d];
      detector.delay_s = set.compared[d].detector.by_visibility[v].delay_s;
      detector.detection = set.compared[d].detector.by_visibility[v].detection;
      detector.delay_minus_doc_s = set.compared[d].delay_minus_other_s[v];
      AddDetected(runs.fog[*one][v], set.thresholds[*one].threshold, detector);
    }
  }
}

ConflictSet RunSet(const StudyContext& context, std::string_view fog, const ConflictNoise& noise,
                   const ShowUnit& show) {
  ConflictSet set{
      .fog = std::string(fog), .noise = std::string(noise.name), .seeds = context.seeds.count()};
  const ConflictSituation situation{fog, noise};
  const Traffic clear_air = TrafficOf(ScenarioInClearAir(context, situation));
  SetRuns runs = RunFirstClearAir(context, clear_air, show);
  set.runs = 2 * set.seeds;
  RunFogs(context, situation, show, runs, set);
  SetThresholds(runs, set);
  std::vector<AlarmTimes> alarms = CommonAlarms(runs, set);
  set.counts_as = CountsAs(set, alarms);
  SetTelling(context, runs, set);
  if (set.Ranks()) {
    RunFurtherClearAir(context, clear_air, {QuickDetectors(), 0, kQuickClearAir}, show, runs);
    RunFurtherClearAir(context, clear_air, {SlowDetectors(), 0, kSlowClearAir}, show, runs);
    set.runs += (kQuickClearAir + kSlowClearAir) * set.seeds;
    SetThresholds(runs, set);
    for (std::size_t d = 0; d < alarms.size(); ++d) {
      AddAlarms(runs.further_air[d], set.thresholds[d].threshold, alarms[d].further);
    }
    set.counts_as = CountsAs(set, alarms);
  } else {
    for (std::int64_t i = 0; i < 2 * set.seeds; ++i) show();
  }
  AddDetection(context, runs, set);
  return set;
}

}  // namespace

bool ConflictSet::Ranks() const {
  return std::ranges::count(outcomes, Telling::kRanks, &ConflictOutcome::telling) > 0;
}

Estimate ConflictSet::Difference(std::size_t a, std::size_t b) const {
  return IsCompared(a) && IsCompared(b) ? DelayDifference(compared[a], compared[b]) : Estimate{};
}

std::vector<ConflictSet> RunConflictSets(const StudyContext& context) {
  // Units of progress for each seed: two runs in clear air, one run in the fog of each visibility,
  // one unit for all further runs of the quick detectors, and one for those of the slow detectors.
  constexpr std::size_t kUnits = 2 + kVisibilities_m.size() + 2;
  const std::int64_t all =
      context.seeds.count() *
      static_cast<std::int64_t>(kFogModels.size() * ConflictNoises().size() * kUnits);
  std::vector<ConflictSet> sets;
  std::int64_t done = 0;
  const auto show = [&] { context.Show(++done, all); };
  for (const std::string_view fog : kFogModels) {
    for (const ConflictNoise& noise : ConflictNoises())
      sets.push_back(RunSet(context, fog, noise, show));
  }
  return sets;
}

std::vector<DelayOutcome> RunDelays(const StudyContext& context,
                                    std::span<const std::size_t> detectors,
                                    const std::vector<std::string>& overrides) {
  const ConflictSituation situation{
      kFogModels[0], *std::ranges::find(ConflictNoises(), kUsualNoise, &ConflictNoise::name),
      overrides};
  std::int64_t done = 0;
  const auto show = [&] { context.Show(++done, kDelayUnits * context.seeds.count()); };
  const Traffic air = TrafficOf(ScenarioInClearAir(context, situation));
  const ClearRuns clear =
      RunClearAir(context, air,
                  {.detectors = {detectors.begin(), detectors.end()},
                   .first_seed = kFurtherClearAirSeeds + kDelayClearAir * context.seeds.first,
                   .runs_per_seed = kDelayClearAir},
                  show);
  DetectionRule rule{
      .arl_zero_s = kArlZero_s, .missed_s = kFog_s, .ranked = {}, .jobs = context.jobs};
  std::vector<std::vector<std::vector<ScoreRecords>>> fog(detectors.size());
  for (const double visibility_m : kVisibilities_m) {
    rule.ranked.push_back(rule.ranked.size());
    const Traffic traffic = TrafficOf(ScenarioInFog(context, situation, visibility_m));
    std::vector<std::vector<ScoreRecords>> records =
        RecordsInFog(context, traffic, detectors, show);
    for (std::size_t d = 0; d < fog.size(); ++d) fog[d].push_back(std::move(records[d]));
  }
  std::vector<DetectorRuns> runs;
  for (std::size_t d = 0; d < fog.size(); ++d) runs.push_back({.clear = clear[d], .fog = fog[d]});
  std::vector<DelayOutcome> outcomes;
  for (DetectionComparison& one : CompareDetection(runs, rule)) {
    const std::vector<ClearRun>& from = clear[outcomes.size()];
    const double threshold = ThresholdFinder(from).Threshold(kArlZero_s);
    const DetectorThreshold found{
        .threshold = threshold, .calibrated = CountAlarms(from, threshold), .clear = {}};
    outcomes.push_back({.is_compared = found.is_determined(), .detection = std::move(one)});
  }
  return outcomes;
}

}  // namespace fogline::study
