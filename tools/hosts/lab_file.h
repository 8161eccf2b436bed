// Reads and checks the file of a laboratory.
#pragma once

#include <filesystem>
#include <string_view>

#include "scenario/io/loader.h"
#include "scenario/sections/plans/lab.h"

namespace fogline::hosts {

/// Reads a laboratory. @param name of the file, for messages
/// @throws ScenarioError with every mistake of the file
LabPlan ParseLab(std::string_view text, std::string_view name = "lab");

/// Reads a laboratory from a file. @throws ScenarioError with every mistake of the file
LabPlan LoadLab(const std::filesystem::path& file);

}  // namespace fogline::hosts
