#include "tools/sweep/engine.h"

#include <oneapi/tbb/info.h>

#include <algorithm>
#include <exception>
#include <span>
#include <stdexcept>

#include <fmt/core.h>

#include "common/errors.h"
#include "tools/stats/in_order.h"

namespace fogline::sweep {

namespace {

/// Largest number of rows that are computed at once. A larger number would save little time, and
/// need more memory.
constexpr std::int64_t kRowsAtOnce = 32;

}  // namespace

void SweepWorker::Compute(std::int64_t unit, std::vector<SweepRow>& rows) {
  rows.clear();
  try {
    for (std::int64_t begin = 0; begin < plan_.rows_per_unit(); begin += kRowsAtOnce) {
      ComputeRows(unit, begin, std::min(begin + kRowsAtOnce, plan_.rows_per_unit()), rows);
    }
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{}: error: {} (at {})", plan_.file(), error.what(), plan_.NameOf(unit, row_)));
  } catch (const std::exception& error) {
    throw std::runtime_error(
        fmt::format("{}: {} (at {})", plan_.file(), error.what(), plan_.NameOf(unit, row_)));
  }
}

void SweepWorker::ComputeRows(std::int64_t unit, std::int64_t begin, std::int64_t end,
                              std::vector<SweepRow>& rows) {
  const auto count = static_cast<std::size_t>(end - begin);
  scenarios_.resize(1 + count, plan_.base());
  for (row_ = begin; row_ < end; ++row_) {
    plan_.Configure(unit, row_, scenarios_[1 + static_cast<std::size_t>(row_ - begin)]);
  }
  const std::span all(scenarios_);
  std::vector<PairedRow> computed;
  const std::size_t before = begin == 0 ? 1 : 0;  // number of runs before the run of the first row
  try {
    if (begin == 0) {
      scenarios_[0] = scenarios_[1];
      scenarios_[0].arbitrator.policy = Policy::kNone;
      computed = runs_.Run(all);
    } else {
      computed = runs_.RunMore(all.subspan(1));
    }
  } catch (...) {
    row_ = begin + static_cast<std::int64_t>(std::max(runs_.current(), before) - before);
    throw;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const bool own_pair = scenarios_[1 + i].arbitrator.policy == Policy::kNone;
    rows.push_back({.measures = computed[i].measures,
                    .paired = own_pair ? metrics::PairedMetrics() : computed[i].paired,
                    .without = own_pair ? metrics::FogEffect() : runs_.effect()});
  }
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
