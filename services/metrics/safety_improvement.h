// Measures of a run with traded control that need the paired run without it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "scenario/sections/scenario.h"
#include "services/metrics/sample.h"
#include "services/metrics/track_judge.h"
#include "services/metrics/until_recovery.h"

namespace fogline::metrics {

/// The mean of (without - with)/without over steps, in %. The ratio of one step can be far below 0,
/// never above 1.
class MeanImprovement {
 public:
  void Add(double without, double with) {
    sum_ += (without - with) / without;
    ++steps_;
  }
  /// nullopt without a step.
  std::optional<double> Pct() const;

 private:
  double sum_ = 0;
  std::int64_t steps_ = 0;
};

/// Safety improvement SI of a run with traded control over its baseline, a run without traded
/// control (same scenario, same seed, lambda_A = 1 throughout), in % (Sourav & Cheng 2024):
///
///     SI = 100/n sum (CS_baseline - CS_traded) / CS_baseline
///
/// over the n relevant steps, those in fog with CS_baseline > floor.
class SafetyImprovement {
 public:
  /// @param floor_m at least 0; avoids the ratio 0/0
  explicit SafetyImprovement(double floor_m) : floor_m_(floor_m) {}

  /// Adds a step of both runs.
  /// @throws std::invalid_argument if the samples are not of the same step.
  void Add(const Sample& baseline, const Sample& traded);

  /// SI so far in %; nullopt without a relevant step.
  std::optional<double> Pct() const { return mean_.Pct(); }

 private:
  double floor_m_;
  MeanImprovement mean_;
};

/// SI of two whole runs. If one of them ended early (a collision), SI counts only the steps that
/// both runs have.
/// @throws std::invalid_argument if they do not begin at the same step, or skip steps differently.
std::optional<double> SafetyImprovementPct(std::span<const Sample> baseline,
                                           std::span<const Sample> traded, double floor_m);

/// Measures of a pair of runs. nullopt: the pair has no step that is relevant for the measure.
struct PairedMeasures {
  /// SI, %.
  std::optional<double> si_pct;
  /// The same over more steps, %: from the first step in fog until the tracks of both runs are
  /// right again for good (UntilRecovery), as far as CS_baseline > floor. SI looks only at the fog,
  /// but the automation returns at its end, to a filter that may not have settled.
  std::optional<double> si_until_recovery_pct;
};

/// Calls `visit(name, value, unit, description)` for every measure, as VisitMeasures().
template <class Visitor>
void VisitPairedMeasures(const PairedMeasures& m, Visitor&& visit) {
  const auto number = [&](std::string_view name, std::optional<double> value, std::string_view unit,
                          std::string_view description) { visit(name, value, unit, description); };
  number("si_pct", m.si_pct, "%", "safety improvement over the paired run without traded control");
  number("si_until_recovery_pct", m.si_until_recovery_pct, "%",
         "the same, counted until the tracks of both runs are right again");
}

/// Collects the measures of a pair, step by step.
class PairedAccumulator {
 public:
  explicit PairedAccumulator(const Scenario& scenario);

  /// Adds a step of both runs.
  /// @throws std::invalid_argument if the samples are not of the same step.
  void Add(const Sample& baseline, const Sample& traded);

  PairedMeasures Result() const;

 private:
  double floor_m_;
  TrackJudge track_;
  SafetyImprovement improvement_;
  UntilRecovery<MeanImprovement> until_recovery_;
};

/// Measures of two whole runs of a scenario, over the steps that both runs have.
/// @throws std::invalid_argument as SafetyImprovementPct()
PairedMeasures MeasurePair(std::span<const Sample> baseline, std::span<const Sample> traded,
                           const Scenario& scenario);

}  // namespace fogline::metrics
