// Traffic by SUMO (Debian's package sumo). The module with SUMO is a separate file, because SUMO
// needs 200 shared libraries. The module is loaded only for a scenario whose preceding cars come
// from SUMO.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "scenario/sections/scenario.h"
#include "services/models/traffic/traffic.h"

namespace fogline::models {

/// Path of the module: ../lib/fogline/sumo.so, relative to the folder of the running program.
std::filesystem::path SumoModule();

/// Loads SUMO; the simulation itself begins with Traffic::Begin(). A process runs one simulation at
/// a time: Begin() waits until the run of another object has ended.
/// @throws InputError "/lead/...: message" if SUMO is missing, has another version than
///     lead.sumo.version, or cannot run this scenario
std::unique_ptr<Traffic> LoadSumo(const Scenario& scenario,
                                  const std::filesystem::path& module = SumoModule());

/// The version of SUMO, such as "SUMO 1.15.0". @throws InputError if SUMO is missing
std::string SumoVersion(const std::filesystem::path& module = SumoModule());

}  // namespace fogline::models
