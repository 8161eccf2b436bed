// Facts about this process, and settings for it.
#pragma once

#include <cstdint>
#include <string>

namespace fogline {

struct ProcessUse {
  std::int64_t cpu_ms;     // processor time of all threads since the start of the process
  std::int64_t rss_bytes;  // resident memory
};
ProcessUse MeasureThisProcess();

/// Asks the kernel for two things: to run every thread of this process before all ordinary threads
/// (SCHED_FIFO), and to lock the process's pages in memory. So steps begin on time on a busy
/// machine, too. SCHED_FIFO needs CAP_SYS_NICE or RLIMIT_RTPRIO.
/// @return whether the kernel granted both requests, with SCHED_FIFO for all threads
bool RunBeforeOthers(int priority);

/// Asks the kernel to run the calling thread before all ordinary threads (SCHED_FIFO).
/// @param with_its_threads whether this also applies to the threads that it will start
/// @return whether the kernel granted this
bool RunThreadBeforeOthers(int priority, bool with_its_threads = false);

/// After this call, a write beyond the limit for the size of files (ulimit -f) fails like a write
/// on a full disk. The call affects this process and the processes that it starts. Without the
/// call, the kernel kills the process (SIGXFSZ), and the process cannot report the reason.
void FailWritesBeyondTheSizeLimit();

/// Why a write failed, and what to do if the limit for the size of files is the reason.
/// @param error errno
std::string WhyWriteFailed(int error);

/// Whether the kernel kills this process when its parent ends.
bool EndsWithItsParent();

/// The name of this machine.
std::string HostName();

}  // namespace fogline
