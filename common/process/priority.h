// Real-time priority of processes and threads (SCHED_FIFO). It needs CAP_SYS_NICE or RLIMIT_RTPRIO.
#pragma once

#include <sys/types.h>

namespace fogline {

/// Asks the kernel for two things: to run every thread of this process before all ordinary threads,
/// and to lock the process's pages in memory. So steps begin on time on a busy machine, too.
/// @return whether the kernel granted both requests, with SCHED_FIFO for all threads
bool RunBeforeOthers(int priority);

/// Asks the kernel to run the calling thread before all ordinary threads.
/// @param with_its_threads whether this also applies to the threads that it will start
/// @return whether the kernel granted this
bool RunThreadBeforeOthers(int priority, bool with_its_threads = false);

/// The number of threads of a process of this machine that the kernel runs before all ordinary
/// threads. 0 if there is no such process.
int ThreadsBeforeOthers(pid_t process);

}  // namespace fogline
