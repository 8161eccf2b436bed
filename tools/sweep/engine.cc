#include "tools/sweep/engine.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_pipeline.h>

#include <atomic>
#include <exception>
#include <memory>
#include <stdexcept>

#include <fmt/core.h>

#include "scenario/loader.h"

namespace fogline {
namespace {

// Units under way for each thread: enough to keep all busy while the slowest is waited for.
constexpr int kTokensPerJob = 4;

/// A unit on its way through the pipeline.
struct Batch {
  std::int64_t unit;
  std::vector<SweepRow> rows;
  std::exception_ptr failure;  // instead of rows
};

/// What cannot be computed fails in its turn, so that it is the same whatever `jobs` is.
void Fill(SweepWorker& worker, Batch& batch) {
  try {
    worker.Compute(batch.unit, batch.rows);
  } catch (...) {
    batch.failure = std::current_exception();
  }
}

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
    try {
      plan_.Configure(unit, row, scenario_);
      rows.push_back(ComputeRow());
    } catch (const InputError& error) {
      throw InputError(fmt::format("error: {}: {}", plan_.NameOf(unit, row), error.what()));
    } catch (const std::exception& error) {
      throw std::runtime_error(fmt::format("{}: {}", plan_.NameOf(unit, row), error.what()));
    }
  }
}

SweepRow SweepWorker::ComputeRow() {
  const Policy policy = scenario_.arbitrator.policy;
  if (baseline_.empty() && policy != Policy::kNone) {
    scenario_.arbitrator.policy = Policy::kNone;
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
    if (policy != Policy::kNone && i < baseline_.size()) {
      improvement.Add(baseline_[i++], sample);
    }
  });
  return {.measures = measures.Result(), .si_pct = improvement.Pct()};
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
                                     return std::make_shared<Batch>(Batch{next++, {}, {}});
                                   }) &
          tbb::make_filter<Item, Item>(tbb::filter_mode::parallel,
                                       [&](Item batch) {
                                         if (go_on) Fill(workers.local(), *batch);
                                         return batch;
                                       }) &
          tbb::make_filter<Item, void>(tbb::filter_mode::serial_in_order, [&](const Item& batch) {
            if (!go_on) return;
            try {
              if (batch->failure) std::rethrow_exception(batch->failure);
              go_on = consume(batch->unit, batch->rows);
            } catch (...) {
              go_on = false;
              throw;
            }
          }));
}

int AllCores() { return tbb::info::default_concurrency(); }

}  // namespace fogline
