// What must hold for any bytes whatever that come in as a scenario.
#pragma once

#include <string_view>

namespace fogline {

/// Aborts unless `text` either is a scenario, which then survives printing and reading, or is
/// refused with mistakes that have a place in it. Returns whether it is a scenario.
bool DemandScenarioOrMistakes(std::string_view text);

}  // namespace fogline
