#include "services/metrics/safety_improvement.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "services/metrics/run_metrics.h"

namespace fogline::metrics {
namespace {

/// Adds the steps that both runs have.
template <class Accumulator>
void AddPairs(std::span<const Sample> baseline, std::span<const Sample> traded,
              Accumulator& accumulator) {
  const std::size_t steps = std::min(baseline.size(), traded.size());
  for (std::size_t i = 0; i < steps; ++i) accumulator.Add(baseline[i], traded[i]);
}

}  // namespace

std::optional<double> MeanImprovement::Pct() const {
  constexpr double kPerCent = 100.0;
  if (steps_ == 0) return std::nullopt;
  return kPerCent * sum_ / static_cast<double>(steps_);
}

void SafetyImprovement::Add(const Sample& baseline, const Sample& traded) {
  if (baseline.step != traded.step) {
    throw std::invalid_argument("safety improvement: step " + std::to_string(baseline.step) +
                                " of the baseline does not pair with step " +
                                std::to_string(traded.step));
  }
  const double without = CompromisedSafety(baseline);
  if (!baseline.fog_present || !(without > floor_m_)) return;
  mean_.Add(without, CompromisedSafety(traded));
}

std::optional<double> SafetyImprovementPct(std::span<const Sample> baseline,
                                           std::span<const Sample> traded, double floor_m) {
  SafetyImprovement improvement(floor_m);
  AddPairs(baseline, traded, improvement);
  return improvement.Pct();
}

PairedAccumulator::PairedAccumulator(const Scenario& scenario)
    : floor_m_(scenario.measures.safety_floor_m), track_(scenario), improvement_(floor_m_) {}

void PairedAccumulator::Add(const Sample& baseline, const Sample& traded) {
  improvement_.Add(baseline, traded);
  const double without = CompromisedSafety(baseline);
  until_recovery_.Step(baseline.fog_present || traded.fog_present,
                       track_.IsWrong(baseline) || track_.IsWrong(traded),
                       [&](MeanImprovement& mean) {
                         if (without > floor_m_) mean.Add(without, CompromisedSafety(traded));
                       });
}

PairedMeasures PairedAccumulator::Result() const {
  return {.si_pct = improvement_.Pct(), .si_until_recovery_pct = until_recovery_.sums().Pct()};
}

PairedMeasures MeasurePair(std::span<const Sample> baseline, std::span<const Sample> traded,
                           const Scenario& scenario) {
  PairedAccumulator accumulator(scenario);
  AddPairs(baseline, traded, accumulator);
  return accumulator.Result();
}

}  // namespace fogline::metrics
