// Finds the paired run without traded control of each run: the measures of a pair, such as the
// safety improvement SI, need both.
#pragma once

#include <span>
#include <vector>

#include "services/metrics/safety_improvement.h"
#include "tools/runner/experiment.h"

namespace fogline::cli {

/// The scenario of the paired run: lambda_A = 1 throughout, everything else the same.
Scenario WithoutTradedControl(Scenario scenario);

/// The measures of every run whose pair is among `runs`: a run of the same scenario and seed with
/// policy none, where only the arbitrator differs. They are empty for the others.
std::vector<metrics::PairedMeasures> MeasurePairs(std::span<const runner::LoggedRun> runs);

}  // namespace fogline::cli
