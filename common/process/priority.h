// Real-time priority of processes and threads (SCHED_FIFO). The kernel grants it only to a process
// with CAP_SYS_NICE or a sufficient RLIMIT_RTPRIO.
#pragma once

#include <sys/types.h>

namespace fogline {

/// Asks the kernel for two things: to run every thread of this process before all ordinary threads,
/// and to lock the process's pages in memory. So steps begin on time on a busy machine, too.
/// @return whether the kernel granted both requests, with SCHED_FIFO for all threads
bool RunBeforeOthers(int priority);

/// Asks the kernel to run the calling thread before all ordinary threads.
/// @param with_its_threads whether the threads that the calling thread starts later get the same
///     priority
/// @return whether the kernel granted the request
bool RunThreadBeforeOthers(int priority, bool with_its_threads = false);

/// Counts those threads of a process that the kernel runs before all ordinary threads. The result
/// is 0 if this machine has no such process.
int ThreadsBeforeOthers(pid_t process);

}  // namespace fogline
