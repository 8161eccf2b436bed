// Finds the paired run without traded control of each run: the measures of a pair, such as the
// safety improvement SI, need both.
#pragma once

#include <span>
#include <vector>

#include "services/metrics/fog_effect.h"
#include "services/metrics/safety_improvement.h"
#include "tools/runner/experiment.h"

namespace fogline::cli {

/// The scenario of the paired run: lambda_A = 1 throughout, everything else the same.
Scenario WithoutTradedControl(Scenario scenario);

/// What a run's pair says. Everything is empty if the pair is not there.
struct Pairing {
  metrics::PairedMetrics measures;
  metrics::FogEffect without;  // effect of the fog in the pair, which has no traded control
};

/// The pairing of every run, in the order of `runs`. Its pair is a run of the same scenario and
/// seed with policy none, where only the arbitrator differs.
std::vector<Pairing> MeasurePairs(std::span<const runner::LoggedRun> runs);

}  // namespace fogline::cli
