// Which run is whose pair without traded control: the safety improvement SI needs both.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tools/fogline/experiment.h"

namespace fogline {

/// The scenario of the paired run: lambda_A = 1 throughout, everything else the same.
Scenario WithoutTradedControl(Scenario scenario);

/// SI in % of every run that has its pair among `runs` (same scenario and seed apart from the
/// arbitrator, policy none); nullopt for the others.
std::vector<std::optional<double>> SafetyImprovements(std::span<const LoggedRun> runs);

}  // namespace fogline
