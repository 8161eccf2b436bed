// Reads a JSON tree into the structs of a scenario, and notes every mistake on the way.
#pragma once

#include "scenario/json.h"
#include "scenario/mistakes.h"
#include "scenario/scenario.h"

namespace fogline {

/// The scenario that `root` describes. It is valid only if `mistakes` stays empty.
Scenario ReadScenario(const JsonValue& root, MistakeList& mistakes);

}  // namespace fogline
