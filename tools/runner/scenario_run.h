// One run of a scenario. Every transport gives the same steps and the same digest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/clock.h"
#include "scenario/sections/scenario.h"
#include "services/graph.h"
#include "services/log/input_latency.h"
#include "services/log/remains.h"
#include "services/log/run_log.h"
#include "services/metrics/follower_metrics.h"
#include "services/metrics/gaps/gap_rules.h"
#include "services/metrics/run_metrics.h"
#include "services/metrics/sample.h"
#include "services/metrics/take_over/take_over_measures.h"
#include "services/runtime/coordination/foreign_peers.h"
#include "services/runtime/coordination/send_trouble.h"
#include "services/runtime/transport/traffic_options.h"
#include "services/runtime/wire/other_build.h"
#include "services/runtime/wire/refusals.h"
#include "tools/hosts/run_plan.h"
#include "tools/replay/role_check.h"

namespace fogline::runner {

/// The run that is to be resumed, as read from its log.
struct Resumption {
  log::LogFront front;
  log::Remains remains;
};

struct RunOptions {
  /// direct (one process, no messages), memq (one process, LCM messages in memory), udpm (a process
  /// for each role, a multicast port for this run), tcpq (a process for each role, a TCP relay for
  /// this run), or an LCM URL (a process for each role on that network).
  std::string transport = "udpm";
  /// The option or the variable that has chosen the transport, for error messages.
  std::string transport_source = "--transport";
  /// Event log to write. If the path is empty, the run writes a temporary log, or no log with
  /// transport direct.
  std::filesystem::path log;
  /// The part of the run that the log already has, if the run is resumed.
  std::optional<Resumption> resume;
  std::optional<std::int64_t> run_id;    // id of the run; nullopt: drawn at random
  double pace = 0;                       // simulated seconds per second; 0: no limit
  bool realtime = false;                 // run at this pace by the wall clock, and do not wait for
                                         // slow roles
  std::vector<Role> external;            // roles that are started elsewhere
  hosts::RunPlan hosts;                  // roles that the run starts on other machines
  Duration wait = milliseconds(60'000);  // longest wait until external roles are ready; 0: forever
  Duration stall_limit = milliseconds(4000);
  int restarts = 10;  // limit of restarts for each role that is killed or hangs; 0: no restart
  /// Whether to compute the roles' steps again from the log, and compare the results. By default,
  /// the steps are computed again if roles run on other machines, are started elsewhere, or the run
  /// is resumed.
  std::optional<bool> verify;
  bool same_build = false;  // end the run if a role's build differs from the runner's build
  runtime::TrafficOptions traffic;
  bool progress = true;          // show a bar of the steps if the run takes long
  bool announce = false;         // print on stderr the network of the run and its processes
  bool wall_clock = false;       // in lockstep: write the wall clock of each step into the log
  bool samples = false;          // keep the samples of every step in the result
  std::string command_to_go_on;  // resumes the run; shown to the user if the run ends early
  /// Called with the run's id and the URL of its network, before any role is started. The function
  /// may wait for a person. It is not called for a run in memory, which has no network.
  std::function<void(std::int64_t run_id, const std::string& url)> on_network =
      [](std::int64_t, const std::string&) {};
  /// Called with the same values after on_network, immediately before the roles are started.
  std::function<void(std::int64_t run_id, const std::string& url)> on_run =
      [](std::int64_t, const std::string&) {};
  /// Called when the log's first step was handed to the operating system. May be called several
  /// times.
  std::function<void()> on_logged_step = [] {};
};

/// How often a process was restarted.
struct Restarts {
  std::string role;  // or "relay", the relay of the run
  int count;
  std::string last;  // how the previous process ended
};

struct RunResult {
  std::int64_t seed = 0;
  std::string transport;
  std::int64_t steps = 0;
  std::string digest;
  double wall_s = 0;
  std::int64_t repairs = 0;  // requests to publish a message again
  runtime::Refusals refused{};
  std::vector<runtime::SendTrouble> send_troubles;
  std::vector<runtime::ForeignPeer> foreign_peers;  // processes of other runs on the same network
  std::vector<Restarts> restarts;
  std::vector<runtime::OtherBuild> other_builds;  // roles whose build differs from the runner's
  std::optional<replay::Verification> verification;
  bool checked = true;        // whether every byte of the log agrees with the recorder's reports
  std::filesystem::path log;  // empty if there is no log
  metrics::RunMetrics measures;
  metrics::Lack lack;  // what the log lacks: decides which measures are unknown (IsKnown)
  std::vector<metrics::FollowerMetrics> followers;    // nearest to the host first
  std::vector<metrics::TakeOverMeasures> take_overs;  // one for each request to take over
  std::optional<log::InputLatency> input_latency;     // only for a run in which a person drove
  std::vector<metrics::Sample> samples;               // empty if the caller did not ask for them
  std::optional<log::RealtimeFigures> realtime;       // only for a run in real time
};

/// Checks whether a run of this scenario is possible, before any process starts. The function
/// constructs every part of a run, but computes no step. So it finds fields whose values are valid
/// alone, but not together.
/// @param file name of the scenario for the user
/// @throws ScenarioError if the run is not possible; Diagnostic::rule is then "impossible"
void CheckPossible(const Scenario& scenario, const std::filesystem::path& file);

/// The reason why a scenario cannot run in real time at this speed: its steps would be shorter than
/// the time that nine processes need for a step. "" if the scenario can run. @param speed simulated
/// seconds per second
std::string WhyTooFast(const Scenario& scenario, double speed);

/// Opens the network of a run once, with the key and the faults of the run, and closes it. So a
/// caller finds an error in network, key or faults before a person waits for the run, and before a
/// file is written. With tcpq the function does nothing, because the run starts its own relay.
/// @throws InputError, std::runtime_error as RunScenario()
void CheckNetwork(const RunOptions& options);

/// Runs a scenario to its end and reads the result from its log.
/// @throws InputError for an invalid transport or log, Interrupted after Ctrl-C, std::runtime_error
///     with one line that names the cause when the run fails; a log stays readable
RunResult RunScenario(const Scenario& scenario, const RunOptions& options);

/// A run as read from its log.
struct LoggedRun : log::RunLog {
  RunResult result;
};
/// Reads a run with the samples of all its steps. If the options allow gaps, a step that lacks
/// TRUTH has no sample, and result.take_overs is empty if the measures of take-overs are unknown.
/// @throws InputError
LoggedRun ReadLoggedRun(const std::filesystem::path& log, const log::ReadOptions& options = {});
/// Reads a run, but does not keep its samples. So the memory does not grow with the length of the
/// run.
/// @param scenario the scenario in the log
/// @throws InputError
LoggedRun MeasureLoggedRun(const std::filesystem::path& log, const Scenario& scenario,
                           const log::ReadOptions& options = {});

}  // namespace fogline::runner
