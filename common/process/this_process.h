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
