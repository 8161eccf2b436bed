// The log that a run will write: a file that the user names, or a new one in the default folder.
#pragma once

#include <filesystem>

#include "services/log/log_guard.h"

namespace fogline::cli {

/// Prepares a log file for writing. The function refuses a log that another run is writing. It
/// refuses a non-empty file if `force` is false, and a file that is not an event log even if
/// `force` is true. It also refuses a folder that RequireFolderOf() refuses. If a killed run has
/// left an older log of this name, the function restores the older log and says so on stderr.
/// @throws InputError
log::LogGuard PrepareLog(const std::filesystem::path& log, bool force);

/// Makes the log "logs/STEM-N.lcm" with the first free number N, from 1 on. STEM is the scenario
/// file's name without its extension.
log::LogGuard FreshLog(const std::filesystem::path& scenario_file);

}  // namespace fogline::cli
