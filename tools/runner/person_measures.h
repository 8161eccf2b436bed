// Measures of a person who drives, from the DRIVER_INPUT messages in the log of a run.
#pragma once

#include <cstdint>
#include <set>

#include "tools/runner/scenario_run.h"

namespace fogline::runner {

/// Adds the input latency, and the times of the person's movements after each request to take over,
/// to the result of a run. Reads the log once more, because the requests are known only after all
/// steps were read.
/// @param seats the seats (driver_input_t.instance) that the driver's commands name; other seats do
///     not count. Without seats nothing is added.
/// @throws InputError
void AddPersonMeasures(const std::set<std::int64_t>& seats, LoggedRun& run);

}  // namespace fogline::runner
