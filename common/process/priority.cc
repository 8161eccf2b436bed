#include "common/process/priority.h"

#include <sched.h>
#include <sys/mman.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace fogline {
namespace {

/// @param thread 0: the calling thread
bool RunFirst(pid_t thread, int priority, bool with_its_threads) {
  const sched_param wanted{.sched_priority = priority};
  const int policy = SCHED_FIFO | (with_its_threads ? 0 : SCHED_RESET_ON_FORK);
  return sched_setscheduler(thread, policy, &wanted) == 0;
}

/// The ids of the threads of a process. @param process "self", or a process id
std::vector<pid_t> ThreadsOf(const std::string& process, std::error_code& error) {
  std::vector<pid_t> threads;
  for (const auto& task :
       std::filesystem::directory_iterator("/proc/" + process + "/task", error)) {
    threads.push_back(static_cast<pid_t>(std::atoi(task.path().filename().c_str())));
  }
  return threads;
}

}  // namespace

bool RunThreadBeforeOthers(int priority, bool with_its_threads) {
  return RunFirst(0, priority, with_its_threads);
}

bool RunBeforeOthers(int priority) {
  std::error_code unreadable;
  bool granted = true;
  for (const pid_t thread : ThreadsOf("self", unreadable)) {
    granted = RunFirst(thread, priority, /*with_its_threads=*/false) && granted;
  }
  // Locks pages in memory. Otherwise the kernel may drop a page, and a step would have to wait
  // until this page is read from the disk.
  granted = mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0 && granted;
  return granted && !unreadable;
}

int ThreadsBeforeOthers(pid_t process) {
  std::error_code gone;
  int threads = 0;
  for (const pid_t thread : ThreadsOf(std::to_string(process), gone)) {
    const int policy = sched_getscheduler(thread);
    threads += policy >= 0 && (policy & ~SCHED_RESET_ON_FORK) == SCHED_FIFO ? 1 : 0;
  }
  return threads;
}

}  // namespace fogline
