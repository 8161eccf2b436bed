#include "tools/sweep/paired_runs.h"

namespace fogline::sweep {

/// Collects the measures of a PairedRow, step by step.
class PairedRuns::Accumulators {
 public:
  explicit Accumulators(const Scenario& scenario) : measures_(scenario), pair_(scenario) {}

  /// Adds the next step of the run. `baseline` has the steps of the run without traded control.
  /// That run may end earlier.
  void Add(const metrics::Sample& sample, std::span<const metrics::Sample> baseline) {
    measures_.Add(sample);
    if (steps_ < baseline.size()) pair_.Add(baseline[steps_++], sample);
  }
  PairedRow Result() const { return {.measures = measures_.Result(), .paired = pair_.Result()}; }

 private:
  metrics::MetricsAccumulator measures_;
  metrics::PairedAccumulator pair_;
  std::size_t steps_ = 0;
};

std::vector<PairedRow> PairedRuns::ResultsOf(const std::vector<Accumulators>& all) {
  std::vector<PairedRow> rows;
  rows.reserve(all.size());
  for (const Accumulators& one : all) rows.push_back(one.Result());
  return rows;
}

std::vector<PairedRow> PairedRuns::Run(std::span<const Scenario> scenarios) {
  baseline_.clear();
  metrics::FogEffectAccumulator effect;
  const std::span others = scenarios.subspan(1);
  std::vector<Accumulators> accumulators(others.begin(), others.end());
  runs_.Run(scenarios, [&](std::size_t run, const closed_loop::StepView& step) {
    const metrics::Sample sample = step.ToSample();
    if (run > 0) return accumulators[run - 1].Add(sample, baseline_);
    baseline_.push_back(sample);
    effect.Add(sample);
  });
  effect_ = effect.Result();
  return ResultsOf(accumulators);
}

std::vector<PairedRow> PairedRuns::RunMore(std::span<const Scenario> scenarios) {
  std::vector<Accumulators> accumulators(scenarios.begin(), scenarios.end());
  runs_.Run(scenarios, [&](std::size_t run, const closed_loop::StepView& step) {
    accumulators[run].Add(step.ToSample(), baseline_);
  });
  return ResultsOf(accumulators);
}

}  // namespace fogline::sweep
