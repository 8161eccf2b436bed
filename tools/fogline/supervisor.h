// The roles of a run as processes on this machine: started, watched, and started again when they
// are killed, hang or are deaf. A process that ends by itself has said why, and ends the run.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/runtime/conductor.h"
#include "services/runtime/restart_policy.h"
#include "tools/fogline/experiment.h"
#include "tools/fogline/process_group.h"

namespace fogline {

class Supervisor {
 public:
  struct Options {
    std::string url;
    std::int64_t run_id = 0;
    std::filesystem::path log;
    bool resume = false;                 // the log is that of this run already
    std::vector<std::string> arguments;  // of every process besides
    std::vector<Role> external;          // roles that are not its business
    int restarts = 0;                    // of each role; 0: the first death ends the run
    Duration silence{};  // without a STATUS after which a process hangs and is killed
    std::function<void(const std::string&)> say;  // for a person
  };

  /// Starts every role. @throws std::runtime_error
  Supervisor(Bus& bus, Conductor& conductor, Options options);

  /// Sees who has died or hangs, and starts again whose time has come. Call it every few tens of
  /// milliseconds.
  void Look(TimePoint now);

  /// Says STOP until every process has left; those that do not are killed.
  void End();

  /// The roles that were started again, here or elsewhere.
  std::vector<Restarts> restarts() const;
  const ProcessGroup& group() const { return group_; }

 private:
  struct Child {
    Role role;
    RestartPolicy policy;
    pid_t pid = 0;
    TimePoint started{};
    std::optional<std::int64_t> activity{};  // in the middle of its silence
    std::string killed_for{};                // what it was killed for here
    bool deaf = false;                       // that was deafness
    std::string death{};                     // the last one, in words
    std::optional<TimePoint> start_at{};
    bool gone = false;  // for good, and the run goes on
  };
  void Start(Child& child, TimePoint now);
  /// If that is not possible, it is tried again later.
  void StartAgain(Child& child, TimePoint now);
  void OnExit(const ProcessGroup::Exit& exit, TimePoint now);
  void KillIfItHangs(Child& child, TimePoint now);
  void KillIfItIsDeaf(Child& child);
  void Kill(Child& child, std::string why);
  /// Says of roles that are not started here that they are deaf, once each time.
  void NameTheDeaf();

  Bus& bus_;
  Conductor& conductor_;
  Options options_;
  ProcessGroup group_;
  std::vector<Child> children_;
  std::set<Role> deaf_;  // those that this was said of
};

}  // namespace fogline
