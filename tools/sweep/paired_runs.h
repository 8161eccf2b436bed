// Runs of one seed, each paired with the run without traded control.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scenario/sections/scenario.h"
#include "services/closed_loop/shared_runs.h"
#include "services/metrics/fog_effect.h"
#include "services/metrics/run_metrics.h"
#include "services/metrics/safety_improvement.h"
#include "services/metrics/sample.h"

namespace fogline::sweep {

/// Measures of a run, and measures that compare it with the run without traded control.
struct PairedRow {
  metrics::RunMetrics measures;
  /// Measures that compare the run with the run without traded control, step by step. They use only
  /// the steps that both runs have. A measure is empty if no step counts for it, for example
  /// because the run without traded control has no compromised safety in fog.
  metrics::PairedMetrics paired;
};

/// Computes runs that are paired with one run without traded control. The runs share the steps that
/// are equal (shared_runs.h). Only one thread may use an object. An object keeps its buffers
/// between calls, because allocating them again would take time.
class PairedRuns {
 public:
  /// Computes the runs of all scenarios. The first scenario has no traded control, and the other
  /// runs are paired with its run. @return the rows of the other scenarios
  /// @throws as SharedRuns::Run(); current() is then the position of the scenario whose run has
  /// thrown
  std::vector<PairedRow> Run(std::span<const Scenario> scenarios);
  /// Computes more runs. They are paired with the first run of the latest call of Run().
  std::vector<PairedRow> RunMore(std::span<const Scenario> scenarios);

  /// The samples of the run without traded control.
  const std::vector<metrics::Sample>& baseline() const { return baseline_; }
  /// The effect of the fog in the run without traded control.
  const metrics::FogEffect& effect() const { return effect_; }
  std::size_t current() const { return runs_.current(); }

 private:
  class Accumulators;
  static std::vector<PairedRow> ResultsOf(const std::vector<Accumulators>& all);

  closed_loop::SharedRuns runs_;
  std::vector<metrics::Sample> baseline_;
  metrics::FogEffect effect_;
};

}  // namespace fogline::sweep
