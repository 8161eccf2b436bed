// Reads a JSON tree into the structs of a scenario, and notes every mistake.
#pragma once

#include "scenario/io/diagnostic_list.h"
#include "scenario/io/json.h"
#include "scenario/sections/plans/experiment.h"
#include "scenario/sections/plans/lab.h"
#include "scenario/sections/scenario.h"

namespace fogline {

/// The scenario that `root` describes. The scenario is valid only if `mistakes` stays empty.
Scenario ReadScenario(const JsonValue& root, DiagnosticList& mistakes);

/// The experiment that `root` describes. The experiment is valid only if `mistakes` stays empty.
ExperimentPlan ReadExperiment(const JsonValue& root, DiagnosticList& mistakes);

/// The laboratory that `root` describes. The laboratory is valid only if `mistakes` stays empty.
LabPlan ReadLab(const JsonValue& root, DiagnosticList& mistakes);

}  // namespace fogline
