#include "common/process/this_process.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
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

namespace {

/// @param thread 0: the calling thread
bool RunFirst(pid_t thread, int priority, int flags = SCHED_RESET_ON_FORK) {
  const sched_param wanted{.sched_priority = priority};
  return sched_setscheduler(thread, SCHED_FIFO | flags, &wanted) == 0;
}

}  // namespace

bool RunThreadBeforeOthers(int priority, bool with_its_threads) {
  return RunFirst(0, priority, with_its_threads ? 0 : SCHED_RESET_ON_FORK);
}

bool RunBeforeOthers(int priority) {
  bool granted = true;
  std::error_code unreadable;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", unreadable)) {
    const auto thread = static_cast<pid_t>(std::atoi(task.path().filename().c_str()));
    granted = RunFirst(thread, priority) && granted;
  }
  // Locks pages in memory, because a page that the kernel has dropped must be read from the disk.
  granted = mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0 && granted;
  return granted && !unreadable;
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
