// Finds what the log of an unfinished run contains, in a time that does not depend on the length of
// the log.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "services/log/event_log.h"
#include "services/runtime/wire/scenario_parts.h"

namespace fogline::log {

/// The beginning of a log: its run and scenario.
struct LogFront {
  std::int64_t run_id = 0;
  runtime::ScenarioParts parts;  // empty if the log does not begin with a scenario
  bool realtime = false;
  std::int64_t type_fingerprint = 0;
  LogHead head;  // the part with the scenario; step 0 follows
};

/// Reads the scenario of a log, or as much of it as there is.
/// @throws InputError if the file is no event log
LogFront ReadFront(const std::filesystem::path& file);

/// What a log contains of its run besides the scenario.
struct Remains {
  LogHead head;            // up to the end of the last complete step
  std::int64_t steps = 0;  // complete steps; in real time, steps that have ended
  std::int64_t last = 0;   // byte at which the last of these steps begins
  bool final = false;      // the last of these steps is the last one of the run
};

/// Looks for the last complete step of a log that a recorder was writing, at the end of the file.
/// If a recorder does not leave such an end, the function reads the log from front to back, and
/// stops at the first event that does not continue the log.
/// @param front of the log, with its whole scenario
/// @param alive is called from time to time while it reads the whole log, with the number of steps
///     so far
/// @param tail bytes at the end to look at
/// @throws InputError if it is no event log
Remains ReadRemains(const std::filesystem::path& file, const LogFront& front,
                    const std::function<void(std::int64_t steps)>& alive = {},
                    std::int64_t tail = kTailBytes);

/// Describes the bytes behind the complete steps of a log in lockstep if they are not what an
/// interrupted run leaves: some incomplete steps, a torn event, a seal. "" if they are.
/// @throws InputError if it is no event log
std::string OddEnd(const std::filesystem::path& file, const LogFront& front,
                   const Remains& remains);

}  // namespace fogline::log
