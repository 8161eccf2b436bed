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

/// The name of this machine.
std::string HostName();

}  // namespace fogline
