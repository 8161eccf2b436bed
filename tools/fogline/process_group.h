// The processes of a run on this machine: started, listened to, and ended without a trace whatever
// happens to the runner (the kernel kills them when it dies).
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "services/graph.h"
#include "services/runtime/clock.h"
#include "tools/fogline/last_lines.h"

namespace fogline {

class ProcessGroup {
 public:
  ProcessGroup() = default;
  /// Kills whatever still runs.
  ~ProcessGroup();
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;

  /// Starts a program for a role; what it prints is kept.
  /// @return its process id @throws std::runtime_error as StartChild()
  pid_t Start(Role role, const std::filesystem::path& program,
              const std::vector<std::string>& arguments);

  /// A process that has ended.
  struct Exit {
    Role role;
    pid_t pid;
    std::string how;                 // such as "exited with code 3" or "was killed by signal 9"
    bool killed;                     // by a signal: it could not say why
    std::vector<std::string> lines;  // the last ones that it printed
  };
  /// Reads what the processes print and collects those that have ended since the last call.
  std::vector<Exit> Collect();

  bool empty() const { return processes_.empty(); }
  /// "world 4711, radar 4712, ...", for people who want to look at or signal a process.
  std::string Describe() const;
  /// Sends a signal to all that still run.
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

}  // namespace fogline
