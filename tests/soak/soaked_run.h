// One run of real processes on simulated machines, in which faults happen.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/support/command.h"
#include "tests/support/network.h"

namespace fogline::test {

/// The parameters of a run. They are random, but depend only on the seed of the soak and on the
/// number of the run.
struct Experiment {
  std::string scenario;
  int steps = 0;
  std::vector<std::string> changes;  // "--seed", "7", "--set", "/steps=300", ...

  static Experiment Draw(std::mt19937_64& random);
};

/// The result of a run with an experiment's parameters, without faults and without messages.
struct Undisturbed {
  std::string digest;
  std::uintmax_t log_bytes = 0;
};
/// @throws std::runtime_error if the program fails
Undisturbed RunUndisturbed(const Experiment& experiment);

/// A run in progress, on one machine or with its roles on three machines of one network. A single
/// machine has a default route to another network, as most machines have. The messages of a run on
/// one machine go over loopback, which is the default, or over the interface of the default route.
class SoakedRun {
 public:
  enum class Place { kLoopback, kInterface, kThreeMachines };

  SoakedRun(const Experiment& experiment, Place place, std::vector<std::string> options);

  /// Waits until the log has this share of the bytes of the undisturbed run's log. @return whether
  /// the run is still in progress then; false also after the time limit
  bool WaitForShare(double share, const Undisturbed& whole);
  bool Running() const { return IsAlive(run_->pid()); }

  /// The machines of the run.
  std::vector<const Machine*> machines() const;
  /// @pre the run is on three machines
  const Lab& lab() const { return *lab_; }

  /// The ids of the runner and of all processes of the run on all machines. The runner is first.
  std::vector<pid_t> Processes() const;

  // Each of these functions causes one fault. @return whether it has caused the fault; false if
  // there was no such process, or if the process had ended by itself

  /// Ends the process of a role, drawn at random, by SIGKILL. Starts the role again if this
  /// program, and not the runner, started it.
  bool KillARole(std::mt19937_64& random);
  /// Stops (SIGSTOP) the process of a role that the runner has started. The role is drawn at
  /// random.
  bool StopARole(std::mt19937_64& random) const;
  /// Ends the runner by SIGKILL, waits for its end, and lets another runner resume the run.
  bool KillTheRunnerAndResume();

  /// Waits for the end. @return the exit code and the output of the runner
  Outcome Finish();
  /// The command line of the last runner.
  const std::string& command() const { return command_; }

 private:
  void StartRole(std::size_t role);
  void StartRunner(const std::vector<std::string>& arguments);
  std::vector<std::string> On(std::size_t machine, const std::vector<std::string>& command) const;
  bool SignalAChild(int signal, std::mt19937_64& random) const;

  ScratchFolder folder_;
  std::string log_ = folder_.File("run.lcm");
  std::optional<Machine> machine_;
  std::optional<Lab> lab_;
  std::vector<std::string> options_;
  std::string command_;
  std::deque<std::unique_ptr<Background>> roles_;  // the roles that this program has started
  std::unique_ptr<Background> run_;
};

}  // namespace fogline::test
