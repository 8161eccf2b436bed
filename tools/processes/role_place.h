// A machine on which the processes of a run's roles are started and watched: this machine
// (ProcessGroup), or another one.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/graph.h"

namespace fogline::processes {

class RolePlace {
 public:
  virtual ~RolePlace() = default;
  RolePlace() = default;
  RolePlace(const RolePlace&) = delete;
  RolePlace& operator=(const RolePlace&) = delete;

  /// The name of the machine, as in the STATUS of its processes.
  virtual const std::string& host() const = 0;
  /// The name of the machine in messages for the user; "" for this machine.
  virtual const std::string& name() const = 0;

  /// Starts the program of a role, and keeps its output.
  /// @return the process id on that machine
  /// @throws std::runtime_error if the program cannot be started; the reason may be temporary
  virtual pid_t StartRole(Role role, const std::vector<std::string>& arguments) = 0;

  /// A process that has ended.
  struct Exit {
    Role role;
    pid_t pid;
    std::string how;                 // such as "exited with code 3" or "was killed by signal 9"
    bool killed;                     // whether a signal ended it; then it printed no reason
    std::vector<std::string> lines;  // the last lines that the process printed
  };
  /// The processes that have ended since the last call. Call this function every few tens of
  /// milliseconds.
  virtual std::vector<Exit> Collect() = 0;
  /// Whether the machine has no running process of the run.
  virtual bool empty() const = 0;
  /// Roles and process ids for the user, such as "world 4711, radar 4712".
  virtual std::string Describe() const = 0;

  /// Kills a process that StartRole() has started.
  virtual void Kill(pid_t pid) = 0;
  /// A number that grows while the main thread of a process runs, also in an endless loop; nullopt
  /// if unknown. The number is the processor time of this thread, in ns, plus its number of context
  /// switches.
  virtual std::optional<std::int64_t> ActivityOf(pid_t pid) = 0;
  /// The reason why the state of the processes is unknown at present; "" if it is known.
  virtual std::string WhyOutOfSight() const { return ""; }
};

/// Does the work of RolePlace::ActivityOf() for a process on this machine.
std::optional<std::int64_t> OwnActivityOf(pid_t pid);

}  // namespace fogline::processes
