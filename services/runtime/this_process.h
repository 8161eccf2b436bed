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

/// A write beyond the limit for the size of files (ulimit -f) fails from now on, in this process
/// and those that it starts, as one on a full disk does. Without this the kernel kills the process
/// (SIGXFSZ), which could not say why.
void FailWritesBeyondTheSizeLimit();

/// Why a write failed, and what to do where the limit for the size of files is the reason.
/// @param error errno
std::string WhyWriteFailed(int error);

/// Whether the kernel kills this process when its parent ends.
bool EndsWithItsParent();

/// The name of this machine.
std::string HostName();

}  // namespace fogline
