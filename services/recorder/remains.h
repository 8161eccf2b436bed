// What the log of a run that has not come to its end has of it. How long that takes to find out
// does not depend on the length of the log.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "services/recorder/event_log.h"
#include "services/runtime/scenario_parts.h"

namespace fogline {

/// What a log begins with: whose it is.
struct LogFront {
  std::int64_t run_id = 0;
  ScenarioParts parts;  // empty if the log does not begin with a scenario
  bool realtime = false;
  std::int64_t type_fingerprint = 0;
  LogHead head;  // the scenario; step 0 follows
};

/// Reads the scenario of a log, or as much of it as is there.
/// @throws InputError if the file is no event log
LogFront ReadFront(const std::filesystem::path& file);

/// What a log has of its run besides the scenario.
struct Remains {
  LogHead head;            // up to the end of the last complete step
  std::int64_t steps = 0;  // complete ones; in real time, those that have ended
  std::int64_t last = 0;   // byte at which the last of them begins
  bool final = false;      // the last of them is the last one of the run
};

/// Looks for the last complete step of a log that a recorder was writing, at the end of the file.
/// Only if that end is not as a recorder leaves it, the log is read from front to back, and ends
/// with the first thing that does not continue it.
/// @param front of the log, with its whole scenario
/// @param alive is called from time to time while it reads all, with the number of steps so far
/// @param tail bytes at the end to look at
/// @throws InputError if it is no event log
Remains ReadRemains(const std::filesystem::path& file, const LogFront& front,
                    const std::function<void(std::int64_t steps)>& alive = {},
                    std::int64_t tail = kTailBytes);

/// What follows the complete steps of a log in lockstep, if that is not what a run leaves that is
/// cut off: some incomplete steps, a torn event, a seal. "" if it is.
/// @throws InputError if it is no event log
std::string OddEnd(const std::filesystem::path& file, const LogFront& front,
                   const Remains& remains);

}  // namespace fogline
