// Computes units of work on all cores and delivers their results in order, within constant memory
// (oneTBB pipeline). A program that uses this header must link TBB::tbb.
#pragma once

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_pipeline.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

namespace fogline::stats {

/// Number of units in progress for each thread. It is large enough to keep all threads busy while
/// one slow unit delays the delivery of the units after it.
inline constexpr int kUnitsPerJob = 4;

/// Computes the units from `begin` up to, but not including, `end` on `jobs` threads.
/// `compute(worker, unit)` is called with a worker that `make_worker()` made for the thread.
/// `consume(unit, result)` takes the results, in order of units, and returns false to stop.
/// `consume` sees the same results for every value of `jobs`. An exception of `consume` reaches the
/// caller. If a unit cannot be computed, the units before this unit are delivered first. Then the
/// exception of this unit reaches the caller.
template <class MakeWorker, class Compute, class Consume>
void ComputeInOrder(std::int64_t begin, std::int64_t end, int jobs, const MakeWorker& make_worker,
                    const Compute& compute, const Consume& consume) {
  using Worker = std::invoke_result_t<MakeWorker>;
  using Result = std::invoke_result_t<Compute, Worker&, std::int64_t>;
  struct Batch {
    std::int64_t unit;
    std::optional<Result> result;
    std::exception_ptr failure;  // set instead of the result
  };
  using Item = std::shared_ptr<Batch>;
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(jobs));
  tbb::enumerable_thread_specific<Worker> workers(make_worker);
  std::int64_t next = begin;
  std::atomic<bool> go_on = true;
  const auto start = [&](tbb::flow_control& flow) -> Item {
    if (next == end || !go_on) {
      flow.stop();
      return nullptr;
    }
    return std::make_shared<Batch>(Batch{next++, std::nullopt, nullptr});
  };
  // The exception of a unit is thrown when the unit is delivered, in order. So for every value of
  // `jobs`, the same units are delivered before the exception.
  const auto work = [&](Item batch) {
    if (!go_on) return batch;
    try {
      batch->result.emplace(compute(workers.local(), batch->unit));
    } catch (...) {
      batch->failure = std::current_exception();
    }
    return batch;
  };
  const auto finish = [&](const Item& batch) {
    if (!go_on) return;
    try {
      if (batch->failure) std::rethrow_exception(batch->failure);
      go_on = consume(batch->unit, std::move(*batch->result));
    } catch (...) {
      go_on = false;
      throw;
    }
  };
  tbb::parallel_pipeline(
      static_cast<std::size_t>(jobs) * kUnitsPerJob,
      tbb::make_filter<void, Item>(tbb::filter_mode::serial_in_order, start) &
          tbb::make_filter<Item, Item>(tbb::filter_mode::parallel, work) &
          tbb::make_filter<Item, void>(tbb::filter_mode::serial_in_order, finish));
}

}  // namespace fogline::stats
