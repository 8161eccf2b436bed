// Starts the processes of a run on this machine, reads their output, and ends them. The kernel
// kills these processes when the runner ends.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/clock.h"
#include "services/graph.h"
#include "tools/processes/last_lines.h"
#include "tools/processes/role_place.h"

namespace fogline::processes {

class ProcessGroup : public RolePlace {
 public:
  ProcessGroup();
  /// Kills all processes that still run.
  ~ProcessGroup() override;

  const std::string& host() const override { return host_; }
  const std::string& name() const override { return name_; }

  /// Starts a program for a role, and keeps its output.
  pid_t Start(Role role, const std::filesystem::path& program,
              const std::vector<std::string>& arguments);

  /// Starts the program of a role. This program is in the folder of the running program.
  pid_t StartRole(Role role, const std::vector<std::string>& arguments) override;
  /// Also reads the output of the processes.
  std::vector<Exit> Collect() override;

  bool empty() const override { return processes_.empty(); }
  std::string Describe() const override;
  void Kill(pid_t pid) override;
  std::optional<std::int64_t> ActivityOf(pid_t pid) override { return OwnActivityOf(pid); }
  /// Sends a signal to all processes that still run.
  void Signal(int signal);

 private:
  struct Process {
    Role role;
    pid_t pid;
    int output;  // read end of a pipe for stdout and stderr
    LastLines printed;
  };
  static void ReadOutput(Process& process);

  std::string host_;
  std::string name_;  // empty, because this is the runner's machine
  std::vector<Process> processes_;
};

}  // namespace fogline::processes
