#include "tools/study/detection/conflict_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "services/decision/conflict/conflict_measures.h"
#include "tools/stats/in_order.h"
#include "tools/study/detection/conflict_intervals.h"

namespace fogline::study {
namespace {

constexpr std::array<std::string_view, 2> kFogModels{"bias", "beam"};

/// Noise of the sensors; the filter has matching parameters.
struct Noise {
  std::string_view name;
  double radar_m;
  double lidar_m;
};
// The optimistic noise of paper.json; then data sheet values of a Continental ARS408 at near and at
// far range, with a Velodyne VLP-16.
constexpr std::array kNoises{Noise{"calibrated", 0.01, 0.01}, Noise{kUsualNoise, 0.1, 0.03},
                             Noise{"far-range", 0.4, 0.03}};

// After this time filters and windows are full, and the track has settled.
constexpr double kWarmUp_s = 5;

// First seeds in clear air: far from the seeds in fog, and from each other.
constexpr std::int64_t kCalibrationSeeds = 1'000'000'000;
constexpr std::int64_t kValidationSeeds = 2'000'000'000;

// Fog of at least this level counts as fog in ROC and AUC. Weaker fog counts neither as fog nor as
// clear air.
constexpr double kFogLevel = 0.5;

std::vector<std::string> Overrides(std::string_view fog, const Noise& noise) {
  return {"/arbitrator/policy=traded",
          "/arbitrator/missing_lidar=conflict",
          "/arbitrator/threshold=0",  // the human drives throughout
          fmt::format("/fog/model={}", fog),
          fmt::format("/radar/range_std_m={}", noise.radar_m),
          fmt::format("/lidar/range_std_m={}", noise.lidar_m),
          fmt::format("/fusion/radar_range_std_m={}", std::max(noise.radar_m, 0.04)),
          fmt::format("/fusion/lidar_range_std_m={}", noise.lidar_m)};
}

/// Gives the measures the mounting offset of the sensors.
Scenario KnownMounting(Scenario scenario) {
  scenario.arbitrator.measure_offset_m = scenario.radar.bias_m - scenario.lidar.bias_m;
  return scenario;
}

Scenario ClearAir(const StudyContext& context, std::string_view fog, const Noise& noise) {
  std::vector<std::string> overrides = Overrides(fog, noise);
  overrides.emplace_back("/fog/duration_s=0");
  Scenario scenario = KnownMounting(context.Load("paper.json", overrides));
  scenario.steps = std::llround((kClearRun_s + kWarmUp_s) / scenario.step_s);
  return scenario;
}

Scenario InFog(const StudyContext& context, std::string_view fog, const Noise& noise,
               double visibility_m) {
  std::vector<std::string> overrides = Overrides(fog, noise);
  overrides.push_back(fmt::format("/fog/visibility_m={}", visibility_m));
  overrides.push_back(fmt::format("/fog/duration_s={}", kFog_s));
  Scenario scenario = KnownMounting(context.Load("paper.json", overrides));
  scenario.fog.bias_m *= kReferenceVisibility_m / visibility_m;
  return scenario;
}

/// The runs of all measures in clear air with one seed.
using ClearRuns = std::vector<ClearRun>;

ClearRuns RunClear(DetectorBench& bench, const Scenario& scenario, std::int64_t seed) {
  ClearRuns runs(conflict::ConflictMeasures().size());
  bench.Run(scenario, seed, [&](const truth_t& truth, std::span<const double> scores) {
    const double time_s = static_cast<double>(truth.header.utime) * 1e-6 - kWarmUp_s;
    if (time_s < 0) return;
    for (std::size_t m = 0; m < scores.size(); ++m) {
      ClearRun& run = runs[m];
      run.duration_s = time_s;
      AddScore(scores[m], time_s, run.records);
      if (truth.header.step % kClearStride == 0) run.scores.push_back(scores[m]);
    }
  });
  return runs;
}

/// Runs in clear air, by measure. It calls `show` after each run.
template <class Show>
std::vector<std::vector<ClearRun>> CollectClear(const StudyContext& context,
                                                const Scenario& scenario, std::int64_t first_seed,
                                                const Show& show) {
  std::vector<std::vector<ClearRun>> by_measure(conflict::ConflictMeasures().size());
  stats::ComputeInOrder(
      0, context.seeds.count(), context.jobs, [] { return DetectorBench(); },
      [&](DetectorBench& bench, std::int64_t unit) {
        return RunClear(bench, scenario, first_seed + context.seeds.first + unit);
      },
      [&](std::int64_t, ClearRuns runs) {
        for (std::size_t m = 0; m < runs.size(); ++m) by_measure[m].push_back(std::move(runs[m]));
        show();
        return true;
      });
  return by_measure;
}

/// Results of a measure in clear air.
struct Calibrated {
  std::vector<ClearRun> runs;  // from which the threshold is found
  DetectorThreshold threshold;
  std::vector<std::vector<double>> scores;  // of other runs, by batch, sorted
};

std::size_t BatchOf(std::int64_t unit) { return static_cast<std::size_t>(unit % kBatches); }

template <class Show>
std::vector<Calibrated> Calibrate(const StudyContext& context, const Scenario& clear_air,
                                  const Show& show) {
  auto calibration = CollectClear(context, clear_air, kCalibrationSeeds, show);
  const auto validation = CollectClear(context, clear_air, kValidationSeeds, show);
  std::vector<Calibrated> all;
  for (std::size_t m = 0; m < calibration.size(); ++m) {
    Calibrated& one = all.emplace_back();
    one.runs = std::move(calibration[m]);
    DetectorThreshold& threshold = one.threshold;
    threshold.threshold = ThresholdFinder(one.runs).Threshold(kArlZero_s);
    threshold.calibrated = CountAlarms(one.runs, threshold.threshold);
    threshold.clear = CountAlarms(validation[m], threshold.threshold);
    one.scores.resize(static_cast<std::size_t>(std::min(kBatches, context.seeds.count())));
    for (std::size_t i = 0; i < validation[m].size(); ++i) {
      std::vector<double>& batch = one.scores[BatchOf(static_cast<std::int64_t>(i))];
      batch.insert(batch.end(), validation[m][i].scores.begin(), validation[m][i].scores.end());
    }
    for (std::vector<double>& batch : one.scores) std::ranges::sort(batch);
  }
  return all;
}

/// One measure in one run with fog.
struct FogRun {
  ScoreRecords records;        // from the beginning of the fog
  std::vector<double> scores;  // in fog of at least kFogLevel
  double auc = 0;
  std::array<double, kFalsePositives.size()> true_positives{};
};

std::vector<FogRun> RunFog(DetectorBench& bench, const Scenario& scenario, std::int64_t seed,
                           std::size_t batch, std::span<const Calibrated> calibrated) {
  std::vector<FogRun> runs(calibrated.size());
  bench.Run(scenario, seed, [&](const truth_t& truth, std::span<const double> scores) {
    if (!truth.fog_present) return;
    const double since_s = static_cast<double>(truth.header.utime) * 1e-6 - scenario.fog.start_s;
    for (std::size_t m = 0; m < scores.size(); ++m) {
      AddScore(scores[m], since_s, runs[m].records);
      if (truth.fog_level >= kFogLevel) runs[m].scores.push_back(scores[m]);
    }
  });
  for (std::size_t m = 0; m < runs.size(); ++m) {
    FogRun& run = runs[m];
    const std::vector<double>& clear = calibrated[m].scores[batch];
    run.auc = AreaUnderRoc(run.scores, clear);
    for (std::size_t i = 0; i < kFalsePositives.size(); ++i) {
      run.true_positives[i] = TruePositives(run.scores, clear, kFalsePositives[i]);
    }
    run.scores = {};
  }
  return runs;
}

/// Means over the runs of each batch. Batches are independent of each other, because each has its
/// own runs in fog and in clear air.
class BatchMeans {
 public:
  explicit BatchMeans(std::size_t batches) : sums_(batches, 0.0), counts_(batches, 0.0) {}
  void Add(std::size_t batch, double value) {
    sums_[batch] += value;
    counts_[batch] += 1;
  }
  std::vector<double> Result() const {
    std::vector<double> means = sums_;
    for (std::size_t i = 0; i < means.size(); ++i) means[i] /= counts_[i];
    return means;
  }

 private:
  std::vector<double> sums_;
  std::vector<double> counts_;
};

/// Results of one measure over the seeds of one condition.
struct Gathered {
  explicit Gathered(std::size_t batches)
      : auc(batches), true_positives(kFalsePositives.size(), BatchMeans(batches)) {}
  std::vector<ScoreRecords> records;
  BatchMeans auc;
  std::vector<BatchMeans> true_positives;
};

template <class Show>
std::vector<Gathered> RunCondition(const StudyContext& context, const Scenario& scenario,
                                   std::span<const Calibrated> calibrated, const Show& show) {
  std::vector<Gathered> gathered(calibrated.size(), Gathered(calibrated.front().scores.size()));
  stats::ComputeInOrder(
      0, context.seeds.count(), context.jobs, [] { return DetectorBench(); },
      [&](DetectorBench& bench, std::int64_t unit) {
        return RunFog(bench, scenario, context.seeds.first + unit, BatchOf(unit), calibrated);
      },
      [&](std::int64_t unit, std::vector<FogRun> runs) {
        for (std::size_t m = 0; m < runs.size(); ++m) {
          gathered[m].records.push_back(std::move(runs[m].records));
          gathered[m].auc.Add(BatchOf(unit), runs[m].auc);
          for (std::size_t i = 0; i < kFalsePositives.size(); ++i) {
            gathered[m].true_positives[i].Add(BatchOf(unit), runs[m].true_positives[i]);
          }
        }
        show();
        return true;
      });
  return gathered;
}

/// Adds AUC and ROC, which need no threshold.
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

/// Adds the number of seeds with an alarm, and the mean delay of these alarms.
void AddDetected(std::span<const ScoreRecords> records, double threshold,
                 DetectorOutcome& detector) {
  for (const ScoreRecords& one : records) {
    const std::optional<double> alarm = FirstAlarm(one, threshold);
    if (!alarm) continue;
    ++detector.detected;
    detector.delay_if_detected_s += *alarm;
  }
  detector.delay_if_detected_s /= static_cast<double>(detector.detected);
}

/// Adds the results that need a threshold. `records` are by measure, visibility and seed.
void AddDetection(std::span<const Calibrated> calibrated,
                  std::span<const std::vector<std::vector<ScoreRecords>>> records,
                  ConflictSet& set) {
  std::vector<std::size_t> measures;
  std::vector<DetectorRuns> runs;
  std::optional<std::size_t> doc;
  for (std::size_t m = 0; m < calibrated.size(); ++m) {
    if (!calibrated[m].threshold.is_determined()) continue;
    if (m == 0) doc = 0;  // the first measure
    measures.push_back(m);
    runs.push_back({.clear = calibrated[m].runs, .fog = records[m]});
  }
  const std::vector<DetectionComparison> compared = CompareDetection(runs, doc, kArlZero_s, kFog_s);
  for (std::size_t i = 0; i < measures.size(); ++i) {
    const std::size_t m = measures[i];
    set.means[m].delay_s = compared[i].detector.delay_s;
    set.means[m].delay_minus_doc_s = compared[i].mean_delay_minus_other_s;
    for (std::size_t v = 0; v < set.outcomes.size(); ++v) {
      DetectorOutcome& detector = set.outcomes[v].detectors[m];
      detector.delay_s = compared[i].detector.by_visibility[v].delay_s;
      detector.detection = compared[i].detector.by_visibility[v].detection;
      detector.delay_minus_doc_s = compared[i].delay_minus_other_s[v];
      AddDetected(records[m][v], calibrated[m].threshold.threshold, detector);
    }
  }
}

template <class Show>
ConflictSet RunSet(const StudyContext& context, std::string_view fog, const Noise& noise,
                   const Show& show) {
  ConflictSet set{
      .fog = std::string(fog), .noise = std::string(noise.name), .seeds = context.seeds.count()};
  const std::vector<Calibrated> calibrated =
      Calibrate(context, ClearAir(context, fog, noise), show);
  for (const Calibrated& one : calibrated) set.thresholds.push_back(one.threshold);
  std::vector<std::vector<std::vector<ScoreRecords>>> records(calibrated.size());
  std::vector<std::vector<std::vector<double>>> auc(calibrated.size());  // by visibility, batch
  for (const double visibility_m : kVisibilities_m) {
    std::vector<Gathered> gathered =
        RunCondition(context, InFog(context, fog, noise, visibility_m), calibrated, show);
    AddRoc(gathered,
           set.outcomes.emplace_back(ConflictOutcome{
               .condition = {.fog = set.fog, .noise = set.noise, .visibility_m = visibility_m}}));
    for (std::size_t m = 0; m < gathered.size(); ++m) {
      records[m].push_back(std::move(gathered[m].records));
      auc[m].push_back(gathered[m].auc.Result());
    }
  }
  set.means.resize(calibrated.size());
  for (std::size_t m = 0; m < calibrated.size(); ++m) {
    std::vector<double> means(auc[m].front().size(), 0.0);
    for (const std::vector<double>& batches : auc[m]) {
      for (std::size_t i = 0; i < means.size(); ++i) {
        means[i] += batches[i] / static_cast<double>(kVisibilities_m.size());
      }
    }
    set.means[m].auc = EstimateOf(means);
  }
  AddDetection(calibrated, records, set);
  return set;
}

}  // namespace

std::int64_t ConflictRuns(const StudyContext& context) {
  constexpr std::size_t kSets = kFogModels.size() * kNoises.size();
  return context.seeds.count() * static_cast<std::int64_t>(kSets * (2 + kVisibilities_m.size()));
}

std::vector<ConflictSet> RunConflictSets(const StudyContext& context) {
  std::vector<ConflictSet> sets;
  std::int64_t done = 0;
  const auto show = [&] { context.Show(++done, ConflictRuns(context)); };
  for (const std::string_view fog : kFogModels) {
    for (const Noise& noise : kNoises) sets.push_back(RunSet(context, fog, noise, show));
  }
  return sets;
}

}  // namespace fogline::study
