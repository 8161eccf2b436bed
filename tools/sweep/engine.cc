#include "tools/sweep/engine.h"

#include <oneapi/tbb/info.h>

#include <exception>
#include <stdexcept>

#include <fmt/core.h>

#include "common/errors.h"
#include "tools/stats/in_order.h"

namespace fogline::sweep {

SweepRow RunPaired(closed_loop::ReusedLoop& loop, const Scenario& scenario,
                   std::span<const metrics::Sample> baseline) {
  metrics::MetricsAccumulator measures(scenario);
  metrics::PairedAccumulator pair(scenario);
  std::size_t i = 0;
  loop.Run(scenario, [&](const closed_loop::StepView& step) {
    const metrics::Sample sample = step.ToSample();
    measures.Add(sample);
    if (i < baseline.size()) pair.Add(baseline[i++], sample);
  });
  return {.measures = measures.Result(), .paired = pair.Result(), .without = {}};
}

void SweepWorker::Compute(std::int64_t unit, std::vector<SweepRow>& rows) {
  rows.clear();
  baseline_.clear();
  for (std::int64_t row = 0; row < plan_.rows_per_unit(); ++row) {
    try {
      plan_.Configure(unit, row, scenario_);
      rows.push_back(ComputeRow());
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: error: {} (at {})", plan_.file(), error.what(),
                                   plan_.NameOf(unit, row)));
    } catch (const std::exception& error) {
      throw std::runtime_error(
          fmt::format("{}: {} (at {})", plan_.file(), error.what(), plan_.NameOf(unit, row)));
    }
  }
}

SweepRow SweepWorker::ComputeRow() {
  const Policy policy = scenario_.arbitrator.policy;
  if (baseline_.empty() && policy != Policy::kNone) {
    scenario_.arbitrator.policy = Policy::kNone;
    metrics::FogEffectAccumulator effect;
    loop_.Run(scenario_, [&](const closed_loop::StepView& step) {
      baseline_.push_back(step.ToSample());
      effect.Add(baseline_.back());
    });
    effect_ = effect.Result();
    scenario_.arbitrator.policy = policy;
  }
  if (policy == Policy::kNone) return RunPaired(loop_, scenario_, {});
  SweepRow row = RunPaired(loop_, scenario_, baseline_);
  row.without = effect_;
  return row;
}

void RunSweep(const SweepPlan& plan, std::int64_t begin, std::int64_t end, int jobs,
              const UnitConsumer& consume) {
  stats::ComputeInOrder(
      begin, end, jobs, [&plan] { return SweepWorker(plan); },
      [](SweepWorker& worker, std::int64_t unit) {
        std::vector<SweepRow> rows;
        worker.Compute(unit, rows);
        return rows;
      },
      consume);
}

int AllCores() { return tbb::info::default_concurrency(); }

}  // namespace fogline::sweep
