// Measures of a run with traded control that need the paired run without traded control.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "scenario/sections/scenario.h"
#include "services/metrics/sample.h"
#include "services/metrics/track/track_judge.h"
#include "services/metrics/track/until_recovery.h"

namespace fogline::metrics {

/// The mean over steps of (without - with)/without, in %. `without` and `with` are the compromised
/// safety of the step without and with traded control. The ratio of one step can be far below 0,
/// but never above 1.
class MeanImprovement {
 public:
  void Add(double without, double with) {
    sum_ += (without - with) / without;
    ++steps_;
  }
  /// The mean; nullopt without a step.
  std::optional<double> Pct() const;

 private:
  double sum_ = 0;
  std::int64_t steps_ = 0;
};

/// An interpretation of "compromised safety". d_f is the gap of the first following car, d_r,f its
/// dynamic safe distance, and t_0 the first step in fog. Fogline measures kBelowSafeDistance. The
/// two other interpretations are computed only to show how much SI depends on the interpretation.
enum class SafetyReading {
  kBelowSafeDistance,  // max(0, d_r,f - d_f)
  kGapLost,            // max(0, d_f(t_0) - d_f)
  kSafeDistanceLost,   // max(0, d_r,f(t_0) - d_r,f)
};

/// Compromised safety of one run under one interpretation, m. Takes the steps of the run in their
/// order.
class CompromisedSafetyOfRun {
 public:
  explicit CompromisedSafetyOfRun(SafetyReading reading) : reading_(reading) {}

  /// Compromised safety of the next step. With kGapLost and kSafeDistanceLost, the result before
  /// the fog is 0.
  double Next(const Sample& sample);

 private:
  SafetyReading reading_;
  std::optional<double> at_begin_m_;  // value at the beginning of the fog
};

/// Safety improvement SI of a run with traded control over its baseline, in % (Sourav & Cheng
/// 2024). The baseline is a run without traded control (same scenario, same seed, lambda_A = 1 in
/// every step).
///
///     SI = 100/n sum (CS_baseline - CS_traded) / CS_baseline
///
/// The sum has the n relevant steps: the steps in fog with CS_baseline > floor. The floor is a free
/// parameter of SI, because the paper states no floor.
class SafetyImprovement {
 public:
  /// @param floor_m at least 0; avoids the ratio 0/0
  explicit SafetyImprovement(double floor_m,
                             SafetyReading reading = SafetyReading::kBelowSafeDistance)
      : floor_m_(floor_m), baseline_(reading), traded_(reading) {}

  /// Adds a step of both runs.
  /// @throws std::invalid_argument if the samples are not of the same step.
  void Add(const Sample& baseline, const Sample& traded);

  /// SI so far in %; nullopt without a relevant step.
  std::optional<double> Pct() const { return mean_.Pct(); }

 private:
  double floor_m_;
  CompromisedSafetyOfRun baseline_;
  CompromisedSafetyOfRun traded_;
  MeanImprovement mean_;
};

/// A choice of interpretation and floor, on which the value of SI depends.
struct SafetyChoice {
  std::string_view name;  // name in JSON
  std::string_view text;  // text for readers
  SafetyReading reading;
  std::optional<double> floor_m;  // nullopt: the floor of the scenario
};
inline constexpr std::array<SafetyChoice, 7> kSafetyChoices{{
    {"floor_20mm", "20 mm", SafetyReading::kBelowSafeDistance, 0.02},
    {"floor_10mm", "10 mm", SafetyReading::kBelowSafeDistance, 0.01},
    {"floor_5mm", "5 mm", SafetyReading::kBelowSafeDistance, 0.005},
    {"floor_1mm", "1 mm", SafetyReading::kBelowSafeDistance, 0.001},
    {"floor_0mm", "0 mm", SafetyReading::kBelowSafeDistance, 0.0},
    {"gap_lost", "gap lost", SafetyReading::kGapLost, std::nullopt},
    {"safe_distance_lost", "d_r,f lost", SafetyReading::kSafeDistanceLost, std::nullopt},
}};

/// SI of two whole runs. If one run ended early (a collision), SI counts only the steps that both
/// runs have.
/// @throws std::invalid_argument if the runs do not begin at the same step, or skip different
/// steps.
std::optional<double> SafetyImprovementPct(std::span<const Sample> baseline,
                                           std::span<const Sample> traded, double floor_m);

/// Measures of a pair of runs. A field is nullopt if the pair has no step that is relevant for the
/// measure.
struct PairedMetrics {
  /// SI, %.
  std::optional<double> si_pct;
  /// SI over a longer interval, %. The interval begins with the first step in fog. The interval
  /// ends with the last step in which one of the runs is in fog or has a wrong track
  /// (UntilRecovery). Only steps with CS_baseline > floor count. si_pct uses only steps in fog. But
  /// after the end of the fog the automation drives again, and the track may still be wrong. So
  /// traded control can affect the safety also in these steps.
  std::optional<double> si_until_recovery_pct;
  /// SI with other choices, %, in the order of kSafetyChoices. `fogline table` shows them.
  std::array<std::optional<double>, kSafetyChoices.size()> other_si_pct;
};

/// Calls `visit(name, value, unit, description)` for every measure except `other_si_pct`, like
/// VisitMetrics().
template <class Visitor>
void VisitPairedMetrics(const PairedMetrics& m, Visitor&& visit) {
  const auto number = [&](std::string_view name, std::optional<double> value, std::string_view unit,
                          std::string_view description) { visit(name, value, unit, description); };
  number("si_pct", m.si_pct, "%", "safety improvement over the paired run without traded control");
  number("si_until_recovery_pct", m.si_until_recovery_pct, "%",
         "the same, counted until the tracks of both runs have recovered");
}

/// Collects the measures of a pair, step by step.
class PairedAccumulator {
 public:
  explicit PairedAccumulator(const Scenario& scenario);

  /// Adds a step of both runs.
  /// @throws std::invalid_argument if the samples are not of the same step.
  void Add(const Sample& baseline, const Sample& traded);

  PairedMetrics Result() const;

 private:
  double floor_m_;
  TrackJudge track_;
  SafetyImprovement improvement_;
  std::array<SafetyImprovement, kSafetyChoices.size()> others_;
  UntilRecovery<MeanImprovement> until_recovery_;
};

/// Measures of two whole runs of a scenario, over the steps that both runs have.
/// @throws std::invalid_argument in the same cases as SafetyImprovementPct()
PairedMetrics MeasurePair(std::span<const Sample> baseline, std::span<const Sample> traded,
                          const Scenario& scenario);

}  // namespace fogline::metrics
