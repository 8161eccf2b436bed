// Arguments that name the network and the roles of a run, for the verbs that make runs.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "scenario/sections/scenario.h"
#include "tools/hosts/run_plan.h"
#include "tools/runner/scenario_run.h"

namespace fogline::cli {

/// The options --transport, --lcm-url, --external, --wait, --same-build, --verify, --key, --faults,
/// and the options that start roles on other machines.
class TransportArguments {
 public:
  /// @param transport the transport of a run if the user chooses none. There are two exceptions:
  ///     - If `transport` is direct, but roles are on other machines, the run uses udpm.
  ///     - If $LCM_DEFAULT_URL is set, the run uses this URL. But a run with direct and without
  ///       external roles ignores $LCM_DEFAULT_URL.
  TransportArguments(CLI::App& verb, std::string transport);

  /// Sets the transport, the options of its traffic, and the roles that are started elsewhere.
  /// @throws InputError for a contradiction between these options
  void Apply(runner::RunOptions& options) const;

 private:
  /// The transport of a run, and the option or variable that has chosen it.
  std::pair<std::string, std::string> Chosen(const hosts::RunPlan& plan) const;
  /// @throws InputError if roles on other machines cannot join the run
  void CheckHosts(const runner::RunOptions& options) const;

  std::string transport_;
  CLI::Option* said_;  // --transport
  std::string url_;
  std::vector<std::string> external_;
  hosts::PlanWords hosts_;
  double wait_s_ = 60;
  bool same_build_ = false;
  bool verify_ = false;
  bool no_verify_ = false;
  runtime::TrafficOptions traffic_;
};

/// Whether a run with this transport has all its roles in one process.
bool IsOneProcess(const std::string& transport);

/// @param what the feature that needs a process for each role, such as "a live replay"
/// @throws InputError if all roles of a run with these options are in one process
void RequireProcesses(const runner::RunOptions& options, std::string_view what);

/// Sets the options for a run in real time.
/// @param speed simulated seconds per second
/// @throws InputError if the other options do not allow real time
void RunInRealtime(runner::RunOptions& options, double speed);

/// @throws InputError if the steps are too short for real time at this speed
void CheckPeriod(const Scenario& scenario, double speed);

}  // namespace fogline::cli
