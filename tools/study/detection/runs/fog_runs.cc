#include "tools/study/detection/runs/fog_runs.h"

#include <algorithm>
#include <utility>

#include "tools/stats/in_order.h"

namespace fogline::study {
namespace {

// Fog of at least this level (truth_t::fog_level, 0 to 1) counts as fog in ROC and AUC. Weaker fog
// counts neither as fog nor as clear air.
constexpr double kFogLevel = 0.5;

std::size_t BatchOf(std::int64_t unit) { return static_cast<std::size_t>(unit % kBatches); }

double SinceFog_s(const truth_t& truth) {
  return static_cast<double>(truth.header.utime) * 1e-6 - kWarmUp_s;
}

/// Results of one detector in one run with fog.
struct FogRun {
  ScoreRecords records;        // from the beginning of the fog
  std::vector<double> scores;  // in fog of at least kFogLevel
  double auc = 0;
  std::array<double, kFalsePositives.size()> true_positives{};
};

std::vector<FogRun> RunFog(SensorBench& bench, std::int64_t seed, std::size_t batch,
                           std::span<const SortedBatches> clear_scores) {
  std::vector<FogRun> runs(clear_scores.size());
  bench.Run(seed, [&](const truth_t& truth, std::span<const double> scores) {
    if (!truth.fog_present) return;
    const double since_s = SinceFog_s(truth);
    for (std::size_t d = 0; d < scores.size(); ++d) {
      AddScore(scores[d], since_s, runs[d].records);
      if (truth.fog_level >= kFogLevel) runs[d].scores.push_back(scores[d]);
    }
  });
  for (std::size_t d = 0; d < runs.size(); ++d) {
    FogRun& run = runs[d];
    const std::vector<double>& clear = clear_scores[d][batch];
    run.auc = AreaUnderRoc(run.scores, clear);
    for (std::size_t i = 0; i < kFalsePositives.size(); ++i) {
      run.true_positives[i] = TruePositives(run.scores, clear, kFalsePositives[i]);
    }
    run.scores = {};
  }
  return runs;
}

}  // namespace

std::vector<SortedBatches> SortScores(std::span<const std::vector<ClearRun>> by_detector) {
  std::vector<SortedBatches> all;
  for (const std::vector<ClearRun>& runs : by_detector) {
    SortedBatches& batches =
        all.emplace_back(std::min<std::size_t>(static_cast<std::size_t>(kBatches), runs.size()));
    for (std::size_t i = 0; i < runs.size(); ++i) {
      std::vector<double>& batch = batches[BatchOf(static_cast<std::int64_t>(i))];
      batch.insert(batch.end(), runs[i].scores.begin(), runs[i].scores.end());
    }
    for (std::vector<double>& batch : batches) std::ranges::sort(batch);
  }
  return all;
}

std::vector<Gathered> RunInFog(const StudyContext& context, const Traffic& traffic,
                               std::span<const SortedBatches> clear_scores, const ShowUnit& show) {
  std::vector<Gathered> gathered(clear_scores.size(), Gathered(clear_scores.front().size()));
  const std::vector<std::size_t> all = AllDetectors();
  stats::ComputeInOrder(
      0, context.seeds.count(), context.jobs, [&] { return SensorBench(traffic, all); },
      [&](SensorBench& bench, std::int64_t unit) {
        return RunFog(bench, context.seeds.first + unit, BatchOf(unit), clear_scores);
      },
      [&](std::int64_t unit, std::vector<FogRun> runs) {
        for (std::size_t d = 0; d < runs.size(); ++d) {
          gathered[d].records.push_back(std::move(runs[d].records));
          gathered[d].auc.Add(BatchOf(unit), runs[d].auc);
          for (std::size_t i = 0; i < kFalsePositives.size(); ++i) {
            gathered[d].true_positives[i].Add(BatchOf(unit), runs[d].true_positives[i]);
          }
        }
        show();
        return true;
      });
  return gathered;
}

std::vector<std::vector<ScoreRecords>> RecordsInFog(const StudyContext& context,
                                                    const Traffic& traffic,
                                                    std::span<const std::size_t> detectors,
                                                    const ShowUnit& show) {
  std::vector<std::vector<ScoreRecords>> by_detector(detectors.size());
  stats::ComputeInOrder(
      0, context.seeds.count(), context.jobs, [&] { return SensorBench(traffic, detectors); },
      [&](SensorBench& bench, std::int64_t unit) {
        std::vector<ScoreRecords> records(detectors.size());
        bench.Run(context.seeds.first + unit,
                  [&](const truth_t& truth, std::span<const double> scores) {
                    if (!truth.fog_present) return;
                    for (std::size_t d = 0; d < scores.size(); ++d) {
                      AddScore(scores[d], SinceFog_s(truth), records[d]);
                    }
                  });
        return records;
      },
      [&](std::int64_t, std::vector<ScoreRecords> records) {
        for (std::size_t d = 0; d < records.size(); ++d) {
          by_detector[d].push_back(std::move(records[d]));
        }
        show();
        return true;
      });
  return by_detector;
}

}  // namespace fogline::study
