#include "services/metrics/safety_improvement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "services/metrics/run_metrics.h"
#include "services/metrics/surrogate.h"

namespace fogline::metrics {
namespace {

template <std::size_t... i>
std::array<SafetyImprovement, sizeof...(i)> OtherChoices(double floor_m,
                                                         std::index_sequence<i...> /*all*/) {
  return {
      SafetyImprovement(kSafetyChoices[i].floor_m.value_or(floor_m), kSafetyChoices[i].reading)...};
}

/// Adds the steps that both runs have.
template <class Accumulator>
void AddPairs(std::span<const Sample> baseline, std::span<const Sample> traded,
              Accumulator& accumulator) {
  const std::size_t steps = std::min(baseline.size(), traded.size());
  for (std::size_t i = 0; i < steps; ++i) accumulator.Add(baseline[i], traded[i]);
}

[[noreturn]] void RefuseToPair(const Sample& baseline, const Sample& traded) {
  throw std::invalid_argument("safety improvement: step " + std::to_string(baseline.step) +
                              " of the baseline does not pair with step " +
                              std::to_string(traded.step));
}

}  // namespace

std::optional<double> MeanImprovement::Pct() const {
  constexpr double kPerCent = 100.0;
  if (steps_ == 0) return std::nullopt;
  return kPerCent * sum_ / static_cast<double>(steps_);
}

double CompromisedSafetyOfRun::Next(const Sample& sample) {
  if (reading_ == SafetyReading::kBelowSafeDistance) return CompromisedSafety(sample);
  const double now_m =
      reading_ == SafetyReading::kGapLost ? sample.follower_gap_m : sample.follower_safe_distance_m;
  if (sample.fog_present && !at_begin_m_) at_begin_m_ = now_m;
  return CompromisedSafety(at_begin_m_.value_or(now_m), now_m);
}

void SafetyImprovement::Add(const Sample& baseline, const Sample& traded) {
  if (baseline.step != traded.step) RefuseToPair(baseline, traded);
  if (!baseline.fog_present && !traded.fog_present) return;  // neither run is in fog
  const double without = baseline_.Next(baseline);
  const double with = traded_.Next(traded);
  if (!baseline.fog_present || !(without > floor_m_) || std::isnan(with)) return;
  mean_.Add(without, with);
}

std::optional<double> SafetyImprovementPct(std::span<const Sample> baseline,
                                           std::span<const Sample> traded, double floor_m) {
  SafetyImprovement improvement(floor_m);
  AddPairs(baseline, traded, improvement);
  return improvement.Pct();
}

PairedAccumulator::PairedAccumulator(const Scenario& scenario)
    : floor_m_(scenario.measures.safety_floor_m),
      track_(scenario),
      improvement_(floor_m_),
      others_(OtherChoices(floor_m_, std::make_index_sequence<kSafetyChoices.size()>())) {}

void PairedAccumulator::Add(const Sample& baseline, const Sample& traded) {
  improvement_.Add(baseline, traded);
  for (SafetyImprovement& other : others_) other.Add(baseline, traded);
  const double without = CompromisedSafety(baseline);
  until_recovery_.Step(baseline.fog_present || traded.fog_present,
                       track_.IsWrong(baseline) || track_.IsWrong(traded),
                       [&](MeanImprovement& mean) {
                         const double with = CompromisedSafety(traded);
                         if (without > floor_m_ && !std::isnan(with)) mean.Add(without, with);
                       });
}

PairedMetrics PairedAccumulator::Result() const {
  PairedMetrics result{.si_pct = improvement_.Pct(),
                       .si_until_recovery_pct = until_recovery_.sums().Pct()};
  std::ranges::transform(others_, result.other_si_pct.begin(), &SafetyImprovement::Pct);
  return result;
}

PairedMetrics MeasurePair(std::span<const Sample> baseline, std::span<const Sample> traded,
                          const Scenario& scenario) {
  PairedAccumulator accumulator(scenario);
  AddPairs(baseline, traded, accumulator);
  return accumulator.Result();
}

}  // namespace fogline::metrics
