// The processes of a run on this machine: starts them, reads their output, and ends them. The
// kernel kills them when the runner dies.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "common/clock.h"
#include "services/graph.h"
#include "tools/processes/last_lines.h"

namespace fogline::processes {

class ProcessGroup {
 public:
  ProcessGroup() = default;
  /// Kills all processes that still run.
  ~ProcessGroup();
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;

  /// Starts a program for a role, and keeps its output.
  pid_t Start(Role role, const std::filesystem::path& program,
              const std::vector<std::string>& arguments);

  /// A process that has ended.
  struct Exit {
    Role role;
    pid_t pid;
    std::string how;                 // such as "exited with code 3" or "was killed by signal 9"
    bool killed;                     // ended by a signal; the process then printed no reason
    std::vector<std::string> lines;  // the last lines that the process printed
  };
  /// Reads the output of the processes and collects the processes that have ended since the last
  /// call.
  std::vector<Exit> Collect();

  bool empty() const { return processes_.empty(); }
  /// "world 4711, radar 4712, ...", for people who want to inspect or signal a process.
  std::string Describe() const;
  /// Sends a signal to all processes that still run.
  void Signal(int signal);

 private:
  struct Process {
    Role role;
    pid_t pid;
    int output;  // read end of a pipe with its stdout and stderr
    LastLines printed;
  };
  static void ReadOutput(Process& process);

  std::vector<Process> processes_;
};

}  // namespace fogline::processes
