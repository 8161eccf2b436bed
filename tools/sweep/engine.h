// Runs the rows of a sweep over all cores and hands them on in their order, within constant memory.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "services/closed_loop/closed_loop.h"
#include "services/measures/measures.h"
#include "tools/sweep/plan.h"

namespace fogline {

/// What a row of a sweep comes to.
struct SweepRow {
  RunMeasures measures;
  /// Safety improvement over the paired run in %; none for a run that is its own pair, and where
  /// the paired run has no compromised safety to improve.
  std::optional<double> si_pct;
};

/// Computes units of a plan, one after another; for one thread. Keeps its buffers.
class SweepWorker {
 public:
  explicit SweepWorker(const SweepPlan& plan) : plan_(plan), scenario_(plan.base()) {}

  /// The rows of a unit, in order. @throws InputError, std::runtime_error that name the row
  void Compute(std::int64_t unit, std::vector<SweepRow>& rows);

 private:
  /// The row of scenario_, and before the first one of a unit its pair without traded control.
  SweepRow ComputeRow();
  /// Runs scenario_ to its end.
  template <class Visit>
  void Run(Visit&& visit);

  const SweepPlan& plan_;
  Scenario scenario_;
  std::optional<ClosedLoop> loop_;
  std::vector<Sample> baseline_;
};

/// Takes the rows of a unit, in order of units; returns false to stop.
using UnitConsumer = std::function<bool(std::int64_t unit, const std::vector<SweepRow>& rows)>;

/// Computes units `begin` to before `end` on `jobs` threads. What the consumer sees does not depend
/// on `jobs`. Exceptions of the consumer come out, and that of the first row that cannot be
/// computed, when the units before have been handed on.
void RunSweep(const SweepPlan& plan, std::int64_t begin, std::int64_t end, int jobs,
              const UnitConsumer& consume);

/// Threads that the machine can run at once.
int AllCores();

}  // namespace fogline
