#include "tools/study/detection/runs/clear_air.h"

#include <iterator>
#include <utility>

#include "tools/stats/in_order.h"

namespace fogline::study {
namespace {

/// Runs by detector.
using RunsByDetector = std::vector<std::vector<ClearRun>>;

/// Makes one run, and adds it to the runs of each detector.
void AddClearRun(SensorBench& bench, std::int64_t seed, bool keeps_scores,
                 RunsByDetector& by_detector) {
  for (std::vector<ClearRun>& runs : by_detector) runs.emplace_back();
  bench.Run(seed, [&](const truth_t& truth, std::span<const double> scores) {
    const double time_s = static_cast<double>(truth.header.utime) * 1e-6 - kWarmUp_s;
    if (time_s < 0) return;
    const bool keeps = keeps_scores && truth.header.step % kClearStride == 0;
    for (std::size_t i = 0; i < scores.size(); ++i) {
      ClearRun& run = by_detector[i].back();
      run.duration_s = time_s;
      AddScore(scores[i], time_s, run.records);
      if (keeps) run.scores.push_back(scores[i]);
    }
  });
}

}  // namespace

std::vector<std::vector<ClearRun>> RunClearAir(const StudyContext& context, const Traffic& traffic,
                                               const ClearAirPlan& plan, const ShowUnit& show) {
  RunsByDetector all(plan.detectors.size());
  stats::ComputeInOrder(
      0, context.seeds.count(), context.jobs, [&] { return SensorBench(traffic, plan.detectors); },
      [&](SensorBench& bench, std::int64_t unit) {
        RunsByDetector runs(plan.detectors.size());
        const std::int64_t first = plan.first_seed + unit * plan.runs_per_seed;
        for (std::int64_t i = 0; i < plan.runs_per_seed; ++i) {
          AddClearRun(bench, first + i, plan.keeps_scores, runs);
        }
        return runs;
      },
      [&](std::int64_t, RunsByDetector runs) {
        for (std::size_t i = 0; i < runs.size(); ++i) {
          all[i].insert(all[i].end(), std::move_iterator(runs[i].begin()),
                        std::move_iterator(runs[i].end()));
        }
        show();
        return true;
      });
  return all;
}

}  // namespace fogline::study
