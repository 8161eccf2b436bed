// Finds the paired run without traded control of each run: the safety improvement SI needs both.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tools/runner/experiment.h"

namespace fogline::cli {

/// The scenario of the paired run: lambda_A = 1 throughout, everything else the same.
Scenario WithoutTradedControl(Scenario scenario);

/// SI in % of every run whose pair is among `runs`: a run of the same scenario and seed with policy
/// none, where only the arbitrator differs. nullopt for the others.
std::vector<std::optional<double>> SafetyImprovements(std::span<const runner::LoggedRun> runs);

}  // namespace fogline::cli
