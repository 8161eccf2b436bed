#include "tools/sweep/engine.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_pipeline.h>

#include <atomic>
#include <memory>

namespace fogline {
namespace {

// Units under way for each thread: enough to keep all busy while the slowest is waited for.
constexpr int kTokensPerJob = 4;

/// A unit on its way through the pipeline.
struct Batch {
  std::int64_t unit;
  std::vector<SweepRow> rows;
};

}  // namespace

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
    plan_.Configure(unit, row, scenario_);
    const Policy policy = scenario_.arbitrator.policy;
    if (baseline_.empty() && policy != Policy::kAutomation) {
      scenario_.arbitrator.policy = Policy::kAutomation;
      Run([this](const StepView& step) { baseline_.push_back(step.ToSample()); });
      scenario_.arbitrator.policy = policy;
    }
    MeasureAccumulator measures;
    SafetyImprovement improvement(scenario_.measures.safety_floor_m);
    std::size_t i = 0;
    Run([&](const StepView& step) {
      const Sample sample = step.ToSample();
      measures.Add(sample);
      // Where one of the pair ended early, SI is over the steps of both.
      if (policy != Policy::kAutomation && i < baseline_.size()) {
        improvement.Add(baseline_[i++], sample);
      }
    });
    rows.push_back({.measures = measures.Result(), .si_pct = improvement.Pct()});
  }
}

void RunSweep(const SweepPlan& plan, std::int64_t begin, std::int64_t end, int jobs,
              const UnitConsumer& consume) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(jobs));
  tbb::enumerable_thread_specific<SweepWorker> workers([&plan] { return SweepWorker(plan); });
  std::int64_t next = begin;
  std::atomic<bool> go_on = true;
  using Item = std::shared_ptr<Batch>;
  tbb::parallel_pipeline(
      static_cast<std::size_t>(jobs) * kTokensPerJob,
      tbb::make_filter<void, Item>(tbb::filter_mode::serial_in_order,
                                   [&](tbb::flow_control& flow) -> Item {
                                     if (next == end || !go_on) {
                                       flow.stop();
                                       return nullptr;
                                     }
                                     return std::make_shared<Batch>(Batch{next++, {}});
                                   }) &
          tbb::make_filter<Item, Item>(tbb::filter_mode::parallel,
                                       [&](Item batch) {
                                         workers.local().Compute(batch->unit, batch->rows);
                                         return batch;
                                       }) &
          tbb::make_filter<Item, void>(tbb::filter_mode::serial_in_order, [&](const Item& batch) {
            if (go_on) go_on = consume(batch->unit, batch->rows);
          }));
}

int AllCores() { return tbb::info::default_concurrency(); }

}  // namespace fogline
