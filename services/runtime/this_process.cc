#include "services/runtime/this_process.h"

#include <unistd.h>

#include <array>
#include <ctime>
#include <fstream>

namespace fogline {

ProcessUse MeasureThisProcess() {
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  // The second number of statm is the resident set in pages (proc(5)).
  std::int64_t pages = 0;
  if (std::ifstream statm("/proc/self/statm"); statm) statm >> pages >> pages;
  return {.cpu_ms = cpu.tv_sec * 1000 + cpu.tv_nsec / 1'000'000,
          .rss_bytes = pages * sysconf(_SC_PAGESIZE)};
}

std::string HostName() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

}  // namespace fogline
