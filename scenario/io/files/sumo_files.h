// A leader from SUMO: the lines of SUMO's files become part of the scenario.
#pragma once

#include <filesystem>
#include <vector>

#include "scenario/io/diagnostic_list.h"
#include "scenario/io/json.h"
#include "scenario/sections/scenario.h"

namespace fogline {

/// Fills lead.sumo.net and lead.sumo.routes with the lines of their files. A list is filled only if
/// it is empty and its file is named. A relative file name is relative to `folder`. The length of a
/// text in a scenario is limited, so a longer line is split at a space. In XML, a line break means
/// the same as a space.
/// @param root the JSON tree of the scenario, which has the place of each value in the sources
/// @param sources the texts from which `root` was read: the scenario file and the overrides
/// @throws ScenarioError if a file cannot be read, is not UTF-8, has a control character within a
/// line, has more lines than the list may have, or has more characters without a space than a text
/// may have
void ResolveSumo(const std::filesystem::path& folder, const JsonValue& root,
                 const std::vector<Source>& sources, Scenario& scenario);

}  // namespace fogline
