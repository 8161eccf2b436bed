// A leader from SUMO: the lines of SUMO's files become part of the scenario.
#pragma once

#include <filesystem>
#include <vector>

#include "scenario/io/diagnostic_list.h"
#include "scenario/io/json.h"
#include "scenario/sections/scenario.h"

namespace fogline {

/// Fills lead.sumo.net and lead.sumo.routes from their files, if a file is named and the list is
/// empty. A relative file name is relative to `folder`. The length of a text in a scenario is
/// limited, so a longer line is split at a space. In XML, a line break means the same as a space.
/// `root` and `sources` are the tree and the sources of the scenario's text. The places of mistakes
/// refer to this tree.
/// @throws ScenarioError if a file cannot be read, is not UTF-8, has more lines than the list may
/// have, or has more characters without a space than a text may have
void ResolveSumo(const std::filesystem::path& folder, const JsonValue& root,
                 const std::vector<Source>& sources, Scenario& scenario);

}  // namespace fogline
