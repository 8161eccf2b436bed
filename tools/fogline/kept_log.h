// What a run that ends early leaves, in words.
#pragma once

#include <cstdint>
#include <string>

#include "tools/fogline/experiment.h"

namespace fogline {

/// "the log so far: FILE" and the command that goes on with it, or that there is no log; "" for a
/// run that was to leave none.
std::string KeptLog(std::int64_t run_id, const ExperimentOptions& options);

/// The command that goes on with the log of a run, with the options that made it and are not in
/// it; "" for a run in real time, or without a log.
std::string CommandToGoOn(const ExperimentOptions& options);

}  // namespace fogline
