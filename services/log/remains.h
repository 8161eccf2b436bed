// Finds the steps that the log of an unfinished run contains. Usually the time for this does not
// depend on the length of the log.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "services/log/event_log.h"
#include "services/runtime/wire/scenario_parts.h"

namespace fogline::log {

/// The beginning of a log: its run, scenario and graph.
struct LogFront {
  std::int64_t run_id = 0;
  runtime::ScenarioParts parts;  // empty if the log does not begin with a scenario
  bool realtime = false;
  std::int64_t type_fingerprint = 0;
  LogHead head;  // the part with scenario and graph; step 0 follows
  // In lockstep: whether the log has the wall clock of each step. Always false if the log does not
  // have the whole step 0.
  bool wall_clock = false;

  /// Number of events of each step in lockstep.
  std::int64_t StepEvents() const;
};

/// Reads the scenario of a log, or the part of the scenario that the log contains.
/// @throws InputError if the file is not an event log
LogFront ReadFront(const std::filesystem::path& file);

/// The steps of the run that a log contains.
struct Remains {
  // The log up to the end of the last complete step. In real time the messages outside of steps
  // that come directly after this step also belong to it.
  LogHead head;
  std::int64_t steps = 0;  // complete steps; in real time, steps that have ended
  std::int64_t last = 0;   // byte at which the last of these steps begins
  bool final = false;      // whether the last of these steps is the last step of the run
};

/// Finds the last complete step of a log that a recorder was writing. Usually the end of the file
/// shows this step. Otherwise the function reads the log from its beginning, and stops at the first
/// event that cannot follow the events before it.
/// @param front scenario and graph of the log; the scenario must be complete
/// @param alive is called repeatedly, with the number of steps so far, while the function
///     reads the whole log
/// @param tail number of bytes at the end of the file that the function reads first
/// @throws InputError if the file is not an event log
Remains ReadRemains(const std::filesystem::path& file, const LogFront& front,
                    const std::function<void(std::int64_t steps)>& alive = {},
                    std::int64_t tail = kTailBytes);

/// Describes unusual bytes after the complete steps of a log in lockstep; "" if there are none.
/// After its complete steps, an interrupted run leaves only some incomplete steps, a torn event or
/// a seal. All other bytes are unusual.
/// @throws InputError if the file is not an event log
std::string OddEnd(const std::filesystem::path& file, const LogFront& front,
                   const Remains& remains);

}  // namespace fogline::log
