#include "common/process/this_process.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fstream>

#include <fmt/core.h>

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

void FailWritesBeyondTheSizeLimit() { std::signal(SIGXFSZ, SIG_IGN); }

std::string WhyWriteFailed(int error) {
  rlimit limit{};
  if (error != EFBIG || getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
    return std::strerror(error);
  }
  return fmt::format("the file size limit of {} bytes is reached; ulimit -f unlimited lifts it",
                     limit.rlim_cur);
}

bool EndsWithItsParent() {
  int signal = 0;
  return prctl(PR_GET_PDEATHSIG, &signal) == 0 && signal == SIGKILL;
}

std::string HostName() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

}  // namespace fogline
