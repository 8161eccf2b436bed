// A recorded leader: its CSV file becomes one speed for each step.
#pragma once

#include <filesystem>
#include <vector>

#include "scenario/io/diagnostic_list.h"
#include "scenario/io/json.h"
#include "scenario/sections/scenario.h"

namespace fogline {

/// Fills lead.recorded.speeds_mps with the speeds at start_s + k step_s, k = 0 to steps - 1, by
/// linear interpolation between the file's rows. A relative file name is relative to `folder`.
/// `root` is the JSON tree of the scenario, and `sources` are the texts from which this tree was
/// read: the scenario file and the overrides. An error names a place in one of these texts or in
/// the recorded file.
/// @throws ScenarioError if the file cannot be read, lacks a column, or does not span the run, or
///     if a cell is not a number, a time does not ascend, or a speed is out of range
void ResolveRecorded(const std::filesystem::path& folder, const JsonValue& root,
                     std::vector<Source> sources, Scenario& scenario);

}  // namespace fogline
