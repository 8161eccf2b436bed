// The processes that a process has started.
#pragma once

#include <sys/types.h>

#include <fstream>
#include <string>
#include <vector>

#include "tests/support/command.h"

namespace fogline::test {

/// Those that have not ended; of its main thread, which is the one that starts them in Fogline.
inline std::vector<pid_t> ChildrenOf(pid_t parent) {
  const std::string id = std::to_string(parent);
  std::ifstream in("/proc/" + id + "/task/" + id + "/children");
  std::vector<pid_t> children;
  for (pid_t child = 0; in >> child;) {
    if (IsAlive(child)) children.push_back(child);
  }
  return children;
}

}  // namespace fogline::test
