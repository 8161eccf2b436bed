#include "tools/study/conflict_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "scenario/loader.h"
#include "services/conflict/measures.h"
#include "tools/sweep/in_order.h"

namespace fogline {
namespace {

constexpr std::array<std::string_view, 2> kFogModels{"bias", "beam"};

/// Noise of the sensors, and what the filter is told of it.
struct Noise {
  std::string_view name;
  double radar_m;
  double lidar_m;
};
// The optimistic one of paper.json; data sheet values of a Continental ARS408 at near and at far
// range beside a Velodyne VLP-16.
constexpr std::array kNoises{Noise{"calibrated", 0.01, 0.01}, Noise{kUsualNoise, 0.1, 0.03},
                             Noise{"far-range", 0.4, 0.03}};

// Filters and windows are full, and the track has settled.
constexpr double kWarmUp_s = 5;

// Seeds in clear air: far from those in fog, and from each other.
constexpr std::int64_t kCalibrationSeeds = 1'000'000'000;
constexpr std::int64_t kValidationSeeds = 2'000'000'000;

// Fog of this level and more counts as fog in ROC and AUC; less is neither fog nor clear air.
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

/// Tells the measures how the sensors are mounted.
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

/// All measures in one run in clear air.
using ClearRuns = std::vector<ClearRun>;

ClearRuns RunClear(DetectorBench& bench, const Scenario& scenario, std::int64_t seed) {
  ClearRuns runs(ConflictMeasures().size());
  bench.Run(scenario, seed, [&](const truth_t& truth, std::span<const double> scores) {
    const double time_s = static_cast<double>(truth.header.utime) * 1e-6 - kWarmUp_s;
    if (time_s < 0) return;
    for (std::size_t m = 0; m < scores.size(); ++m) {
      ClearRun& run = runs[m];
      run.duration_s = time_s;
      if (run.records.empty() || scores[m] > run.records.back().score) {
        run.records.push_back({scores[m], time_s});
      }
      if (truth.header.step % kClearStride == 0) run.scores.push_back(scores[m]);
    }
  });
  return runs;
}

/// Runs in clear air by measure. `show` is told of each.
template <class Show>
std::vector<std::vector<ClearRun>> CollectClear(const StudyContext& context,
                                                const Scenario& scenario, std::int64_t first_seed,
                                                const Show& show) {
  std::vector<std::vector<ClearRun>> by_measure(ConflictMeasures().size());
  ComputeInOrder(
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

/// What is known of a measure from clear air.
struct Calibrated {
  double threshold;
  AlarmCount calibrated;
  AlarmCount clear;
  std::vector<double> scores;  // sorted
};

template <class Show>
std::vector<Calibrated> Calibrate(const StudyContext& context, const Scenario& clear_air,
                                  const Show& show) {
  const auto calibration = CollectClear(context, clear_air, kCalibrationSeeds, show);
  const auto validation = CollectClear(context, clear_air, kValidationSeeds, show);
  std::vector<Calibrated> all;
  for (std::size_t m = 0; m < calibration.size(); ++m) {
    Calibrated& one = all.emplace_back();
    one.threshold = CalibrateThreshold(calibration[m], kArlZero_s);
    one.calibrated = CountAlarms(calibration[m], one.threshold);
    one.clear = CountAlarms(validation[m], one.threshold);
    for (const ClearRun& run : validation[m]) {
      one.scores.insert(one.scores.end(), run.scores.begin(), run.scores.end());
    }
    std::sort(one.scores.begin(), one.scores.end());
  }
  return all;
}

/// One measure in one run with fog.
struct FogRun {
  double delay_s = std::numeric_limits<double>::quiet_NaN();  // NaN: missed
  std::vector<double> scores;                                 // in fog of kFogLevel and more
  double auc = 0;
  std::array<double, kFalsePositives.size()> true_positives{};
};

std::vector<FogRun> RunFog(DetectorBench& bench, const Scenario& scenario, std::int64_t seed,
                           std::span<const Calibrated> calibrated) {
  std::vector<FogRun> runs(calibrated.size());
  bench.Run(scenario, seed, [&](const truth_t& truth, std::span<const double> scores) {
    if (!truth.fog_present) return;
    const double since_s = static_cast<double>(truth.header.utime) * 1e-6 - scenario.fog.start_s;
    for (std::size_t m = 0; m < scores.size(); ++m) {
      FogRun& run = runs[m];
      if (std::isnan(run.delay_s) && scores[m] >= calibrated[m].threshold) run.delay_s = since_s;
      if (truth.fog_level >= kFogLevel) run.scores.push_back(scores[m]);
    }
  });
  for (std::size_t m = 0; m < runs.size(); ++m) {
    FogRun& run = runs[m];
    run.auc = AreaUnderRoc(run.scores, calibrated[m].scores);
    for (std::size_t i = 0; i < kFalsePositives.size(); ++i) {
      run.true_positives[i] = TruePositives(run.scores, calibrated[m].scores, kFalsePositives[i]);
    }
    run.scores = {};
  }
  return runs;
}

void Add(const FogRun& run, DetectorOutcome& outcome) {
  const bool detected = !std::isnan(run.delay_s);
  outcome.delay_s.push_back(detected ? run.delay_s : kFog_s);
  outcome.auc.push_back(run.auc);
  for (std::size_t i = 0; i < kFalsePositives.size(); ++i) {
    outcome.true_positives[i].push_back(run.true_positives[i]);
  }
  if (!detected) return;
  ++outcome.detected;
  outcome.delay_if_detected_s += run.delay_s;  // a sum until all are there
}

template <class Show>
ConflictOutcome RunCondition(const StudyContext& context, const ConflictCondition& condition,
                             const Scenario& scenario, std::span<const Calibrated> calibrated,
                             const Show& show) {
  ConflictOutcome outcome{.condition = condition, .detectors = {}};
  for (const Calibrated& one : calibrated) {
    DetectorOutcome& detector = outcome.detectors.emplace_back();
    detector.threshold = one.threshold;
    detector.calibrated = one.calibrated;
    detector.clear = one.clear;
  }
  ComputeInOrder(
      0, context.seeds.count(), context.jobs, [] { return DetectorBench(); },
      [&](DetectorBench& bench, std::int64_t unit) {
        return RunFog(bench, scenario, context.seeds.first + unit, calibrated);
      },
      [&](std::int64_t, const std::vector<FogRun>& runs) {
        for (std::size_t m = 0; m < runs.size(); ++m) Add(runs[m], outcome.detectors[m]);
        show();
        return true;
      });
  for (DetectorOutcome& detector : outcome.detectors) {
    detector.delay_if_detected_s /= static_cast<double>(detector.detected);
  }
  return outcome;
}

}  // namespace

std::int64_t ConflictRuns(const StudyContext& context) {
  constexpr std::size_t kSets = kFogModels.size() * kNoises.size();
  return context.seeds.count() * static_cast<std::int64_t>(kSets * (2 + kVisibilities_m.size()));
}

std::vector<ConflictOutcome> RunConflictConditions(const StudyContext& context) {
  std::vector<ConflictOutcome> outcomes;
  std::int64_t done = 0;
  const auto show = [&] { context.Show(++done, ConflictRuns(context)); };
  for (const std::string_view fog : kFogModels) {
    for (const Noise& noise : kNoises) {
      const std::vector<Calibrated> calibrated =
          Calibrate(context, ClearAir(context, fog, noise), show);
      for (const double visibility_m : kVisibilities_m) {
        outcomes.push_back(RunCondition(context,
                                        {.fog = std::string(fog),
                                         .noise = std::string(noise.name),
                                         .visibility_m = visibility_m},
                                        InFog(context, fog, noise, visibility_m), calibrated,
                                        show));
      }
    }
  }
  return outcomes;
}

}  // namespace fogline
