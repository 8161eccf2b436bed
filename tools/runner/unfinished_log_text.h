// Text about the log that a run leaves when it ends early.
#pragma once

#include <cstdint>
#include <string>

#include "tools/runner/scenario_run.h"

namespace fogline::runner {

/// A text with the name of the log and the command that resumes it, or a text that says that no log
/// was written; "" for a run without a log.
std::string UnfinishedLogText(std::int64_t run_id, const RunOptions& options);

/// The command that resumes the log of a run. The command has the options of the run that the log
/// does not contain. The result is "" for a run in real time, or for a run without a log.
std::string CommandToGoOn(const RunOptions& options);

}  // namespace fogline::runner
