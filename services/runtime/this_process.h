// What a process can say about itself.
#pragma once

#include <cstdint>
#include <string>

namespace fogline {

struct ProcessUse {
  std::int64_t cpu_ms;     // of all its threads, since it was started
  std::int64_t rss_bytes;  // resident now
};
ProcessUse MeasureThisProcess();

/// Asks the kernel to run every thread of this process before all ordinary ones (SCHED_FIFO), so
/// that its steps begin on time on a busy machine, too. That takes CAP_SYS_NICE, or RLIMIT_RTPRIO.
/// @return whether it was granted to all threads
bool RunBeforeOthers(int priority);

/// Whether the kernel kills this process when its parent ends.
bool EndsWithItsParent();

/// The name of this machine.
std::string HostName();

}  // namespace fogline
