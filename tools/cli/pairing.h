// For each run, finds the paired run without traded control. The measures of a pair, such as the
// safety improvement SI, need both runs.
#pragma once

#include <span>
#include <vector>

#include "services/metrics/fog_effect.h"
#include "services/metrics/safety_improvement.h"
#include "tools/runner/scenario_run.h"

namespace fogline::cli {

/// The scenario of the paired run. Its policy is `none`, so the automation always drives.
/// Everything else is the same.
Scenario WithoutTradedControl(Scenario scenario);

/// The results that need the paired run. Without a paired run, `measures` and `without` are empty.
struct Pairing {
  metrics::PairedMetrics measures;
  metrics::FogEffect without;  // effect of the fog in the paired run without traded control
  bool unknown = false;        // there is a paired run, but one of the two logs is not whole
};

/// The pairing of every run, in the order of `runs`. The paired run has the policy `none` and the
/// same seed. Its scenario differs only in the section `arbitrator`.
std::vector<Pairing> MeasurePairs(std::span<const runner::LoggedRun> runs);

}  // namespace fogline::cli
