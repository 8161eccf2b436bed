// Measures of each car that follows the host, in one pass and constant memory.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "scenario/sections/traffic.h"
#include "services/graph.h"
#include "services/metrics/running.h"

namespace fogline::metrics {

/// Measures of one following car. The car ahead of the first following car is the host. A field is
/// nullopt if the run has no step that is relevant for the measure.
struct FollowerMetrics {
  /// Smallest true gap to the car ahead, m.
  std::optional<double> min_gap_m;
  /// Smallest time to collision with the car ahead, s (Hayward 1972; surrogate.h).
  std::optional<double> min_ttc_s;
  /// Largest compromised safety CS, m, and the mean of CS over the steps in fog. CS is the
  /// shortfall of the gap below the dynamic safe distance of the car's own driver (Sourav & Cheng
  /// 2024).
  std::optional<double> max_compromised_safety_m;
  std::optional<double> mean_compromised_safety_fog_m;
};

/// Calls `visit(name, value, unit, description)` for each measure of a car, like VisitMetrics() for
/// a run.
template <class Visitor>
void VisitFollowerMetrics(const FollowerMetrics& m, Visitor&& visit) {
  const auto number = [&](std::string_view name, std::optional<double> value, std::string_view unit,
                          std::string_view description) { visit(name, value, unit, description); };
  number("min_gap_m", m.min_gap_m, "m", "smallest gap to the car ahead");
  number("min_ttc_s", m.min_ttc_s, "s", "smallest time to collision with it");
  number("max_compromised_safety_m", m.max_compromised_safety_m, "m",
         "largest shortfall of the safe distance");
  number("mean_compromised_safety_fog_m", m.mean_compromised_safety_fog_m, "m",
         "mean shortfall of the safe distance in fog");
}

/// Collects the measures of all following cars, step by step. Add() allocates no memory.
class FollowerAccumulator {
 public:
  /// Adds a step. In real time, the message for `commands` may be missing; `commands` then has no
  /// followers. The safe distances are then unknown, so the step counts only for the gap and the
  /// time to collision.
  void Add(const truth_t& truth, const follower_command_t& commands);

  /// One entry for each following car, nearest to the host first.
  std::vector<FollowerMetrics> Result() const;

 private:
  struct Car {
    FollowerMetrics measures;  // all measures except the mean, which Result() computes
    Mean compromised_safety_fog_m;
  };
  static void AddSafety(bool fog, double compromised_m, Car& car);

  std::array<Car, static_cast<std::size_t>(kMaxFollowers)> cars_;
  std::size_t num_cars_ = 0;
};

}  // namespace fogline::metrics
