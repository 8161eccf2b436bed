// The message log_priority_t in the log of a run: which roles of the run had real-time priority
// (lcmtypes/log_priority_t.lcm). The message is not part of the run, and not in its digest.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/log/event_log.h"

namespace fogline::log {

/// The channel of log_priority_t. The channel is not part of kGraph, because no process publishes
/// it.
inline constexpr std::string_view kLogPriorityChannel = "FOGLINE_PRIORITY";

/// Which roles of a run in real time got a real-time priority at the start of the run. The kernel
/// runs roles with this priority before ordinary processes (SCHED_FIFO). The priority of roles on
/// other machines is unknown.
struct RealtimePriority {
  std::vector<std::string> granted;
  std::vector<std::string> refused;
  std::vector<std::string> unknown;
};

/// The bytes of a log_priority_t.
std::vector<std::uint8_t> EncodePriority(const RealtimePriority& priority, std::int64_t run_id);

/// The roles that an event on kLogPriorityChannel names; nullopt if the event is not of this run.
std::optional<RealtimePriority> ReadPriority(const Event& event, std::int64_t run_id);

}  // namespace fogline::log
