// The processes that a process has started.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "tests/support/command.h"

namespace fogline::test {

/// The children of `parent` that its main thread has started, and that have not ended. In Fogline,
/// other threads start children only when several runs go on at once.
inline std::vector<pid_t> ChildrenOf(pid_t parent) {
  const std::string id = std::to_string(parent);
  std::ifstream in("/proc/" + id + "/task/" + id + "/children");
  std::vector<pid_t> children;
  for (pid_t child = 0; in >> child;) {
    if (IsAlive(child)) children.push_back(child);
  }
  return children;
}

/// The children of `parent` that any of its threads has started, and that have not ended.
inline std::vector<pid_t> ChildrenOfAnyThread(pid_t parent) {
  std::vector<pid_t> children;
  std::error_code ended;
  const std::string tasks = "/proc/" + std::to_string(parent) + "/task";
  for (std::filesystem::directory_iterator task(tasks, ended), none; !ended && task != none;
       task.increment(ended)) {
    std::ifstream in(task->path() / "children");
    for (pid_t child = 0; in >> child;) {
      if (IsAlive(child)) children.push_back(child);
    }
  }
  return children;
}

/// Sends a signal to one process, which must exist. With pid 0, kill(2) would send the signal to
/// all processes of the caller's process group.
inline void SignalOne(pid_t pid, int signal) {
  ASSERT_GT(pid, 0);
  kill(pid, signal);
}

}  // namespace fogline::test
