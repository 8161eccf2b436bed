// Effects of the fog on the traffic, in m and m/s. Reports show these values beside percentages
// such as SI.
#pragma once

#include <optional>

#include "services/metrics/running.h"
#include "services/metrics/sample.h"

namespace fogline::metrics {

/// A field is nullopt if the run has no step in fog. Without a following car, only
/// mean_compromised_safety_m is nullopt.
struct FogEffect {
  /// Mean compromised safety CS of the first following car over the steps in fog, m.
  std::optional<double> mean_compromised_safety_m;
  /// Largest drop of the host's speed in fog below its speed in the first step in fog, m/s.
  std::optional<double> slow_down_mps;
};

/// Collects the effect, step by step.
class FogEffectAccumulator {
 public:
  void Add(const Sample& sample);
  FogEffect Result() const;

 private:
  Mean compromised_safety_m_;
  std::optional<double> speed_at_begin_mps_;
  std::optional<double> slow_down_mps_;
};

}  // namespace fogline::metrics
