// The supervisor of a run's processes, on this machine and on others. It starts and watches the
// processes. It restarts a process that is killed, hangs or is deaf. (In real time, a process is
// deaf if it receives no message on a channel although the producer of the channel computes.) A
// process that exits by itself has printed the reason, and is not started again. (There is one
// exception: a restarted process may exit before its first STATUS. It is then started again and
// again, until the stall timeout ends the run.) In lockstep, the exit of a process by itself ends
// the run. A run in real time goes on without this process if RunCoordinator::GoesOnWithout() is
// true, the process was not deaf, and restarts are allowed.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/runtime/coordination/restart_policy.h"
#include "services/runtime/coordination/run_coordinator.h"
#include "services/runtime/transport/traffic_options.h"
#include "tools/hosts/host_group.h"
#include "tools/processes/process_group.h"
#include "tools/runner/scenario_run.h"

namespace fogline::runner {

class Supervisor {
 public:
  /// A process that prepares for the run may send no STATUS, for example while SUMO loads its
  /// network. For this time it does not count as hanging if it is active (RolePlace::ActivityOf()).
  static constexpr Duration kPrepareLimit = milliseconds(60'000);

  struct Options {
    std::string url;
    std::int64_t run_id = 0;
    std::filesystem::path log;
    bool resume = false;                      // the log already belongs to this run
    bool wall_clock = false;                  // the log has the wall clock of each step
    runtime::TrafficOptions traffic;          // of every process
    std::vector<Role> external;               // roles that are started elsewhere
    const hosts::HostGroup* hosts = nullptr;  // other machines that run roles
    int restarts = 0;    // limit for each role; 0: the first end of a process ends the run
    Duration silence{};  // time without a STATUS after which a process counts as hanging and is
                         // killed
    std::function<void(const std::string&)> say;  // prints a line for the user
  };

  /// Starts every role. @throws std::runtime_error
  Supervisor(runtime::Bus& bus, runtime::RunCoordinator& coordinator, Options options);

  /// Finds processes that have ended. Kills processes that hang, and processes that are deaf
  /// (receive no message of a channel on which messages are sent). Starts a process of a role again
  /// when the wait of its RestartPolicy is over. Call it every few tens of milliseconds.
  void Look(TimePoint now);

  /// Sends STOP until every process has left, but only for a limited time. The destructor kills the
  /// remaining processes.
  void End();

  /// The roles that were restarted, on this machine or elsewhere.
  std::vector<Restarts> restarts() const;
  /// The processes of all machines, for the user; "" if there are none.
  std::string Describe() const;

 private:
  struct Child {
    Role role;
    processes::RolePlace* place;
    runtime::RestartPolicy policy;
    pid_t pid = 0;
    TimePoint started{};
    std::optional<std::int64_t> activity{};  // ActivityOf() at half of the silence limit
    std::string killed_for{};                // the reason why the supervisor killed the process
    bool deaf = false;                       // whether it was killed because it was deaf
    std::string death{};                     // how the role's last process ended
    std::optional<TimePoint> start_at{};
    int ended_at_once = 0;  // processes since the last death that ended before their first STATUS
    bool gone = false;      // whether the process has ended for good while the run continues
    bool hindered = false;  // whether the coordinator has been told why the process is not watched
  };
  void Start(Child& child, TimePoint now);
  /// Restarts the process; if the restart fails, a later call tries again.
  void StartAgain(Child& child, TimePoint now);
  /// The processes that have ended since the last call.
  std::vector<processes::RolePlace::Exit> Collect();
  void OnExit(const processes::RolePlace::Exit& exit, TimePoint now);
  /// Whether the machine of the process answers. If it does not answer, stores the reason for an
  /// error text.
  bool InSight(Child& child);
  void Hinder(Child& child, const std::string& why);
  void KillIfItHangs(Child& child, TimePoint now);
  void KillIfItIsDeaf(Child& child);
  void Kill(Child& child, std::string why);
  /// Reports deaf roles that the supervisor does not restart. A role is reported once each time
  /// that it becomes deaf.
  void NameTheDeaf();

  runtime::Bus& bus_;
  runtime::RunCoordinator& coordinator_;
  Options options_;
  processes::ProcessGroup group_;  // the processes on this machine
  std::vector<processes::RolePlace*> places_;
  std::vector<Child> children_;
  std::set<Role> deaf_;  // deaf roles that were reported
};

}  // namespace fogline::runner
