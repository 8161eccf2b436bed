#include "tools/sweep/engine.h"

#include <oneapi/tbb/info.h>

#include <exception>
#include <stdexcept>

#include <fmt/core.h>

#include "common/errors.h"
#include "tools/stats/in_order.h"

namespace fogline::sweep {

template <class Visit>
void SweepWorker::Run(Visit&& visit) {
  if (loop_) {
    loop_->Restart(scenario_);
  } else {
    loop_.emplace(scenario_);
  }
  loop_->Run(0, visit);
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
    Run([&](const metrics::StepView& step) {
      baseline_.push_back(step.ToSample());
      effect.Add(baseline_.back());
    });
    effect_ = effect.Result();
    scenario_.arbitrator.policy = policy;
  }
  metrics::MetricsAccumulator measures(scenario_);
  metrics::PairedAccumulator pair(scenario_);
  std::size_t i = 0;
  Run([&](const metrics::StepView& step) {
    const metrics::Sample sample = step.ToSample();
    measures.Add(sample);
    // If one run of the pair ended early, the pair has only the steps that both have.
    if (policy != Policy::kNone && i < baseline_.size()) {
      pair.Add(baseline_[i++], sample);
    }
  });
  return {.measures = measures.Result(),
          .paired = pair.Result(),
          .without = policy == Policy::kNone ? metrics::FogEffect() : effect_};
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
