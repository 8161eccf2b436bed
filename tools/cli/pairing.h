// Finds for each run the paired run without traded control: the safety improvement SI needs both.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tools/runner/experiment.h"

namespace fogline::cli {

/// The scenario of the paired run: lambda_A = 1 throughout, everything else the same.
Scenario WithoutTradedControl(Scenario scenario);

/// SI in % of every run whose pair is among `runs`, nullopt for the others. The pair has policy
/// none, and differs from the run in nothing but the arbitrator.
std::vector<std::optional<double>> SafetyImprovements(std::span<const runner::LoggedRun> runs);

}  // namespace fogline::cli
