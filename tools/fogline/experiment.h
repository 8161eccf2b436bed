// One run of a scenario, on any transport: the same steps, the same digest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "services/graph.h"
#include "services/measures/follower_measures.h"
#include "services/measures/measures.h"
#include "services/measures/sample.h"
#include "services/recorder/remains.h"
#include "services/recorder/run_log.h"
#include "services/runtime/clock.h"
#include "services/runtime/other_build.h"
#include "services/runtime/refusals.h"
#include "services/runtime/send_trouble.h"
#include "services/runtime/strangers.h"
#include "services/runtime/traffic_options.h"
#include "tools/fogline/role_check.h"

namespace fogline {

/// The run that a log has a part of.
struct Resumption {
  LogFront front;
  Remains remains;
};

struct ExperimentOptions {
  /// direct (one process, no messages), memq (one process, LCM messages in memory), udpm (a process
  /// for each role, a multicast port of its own), tcpq (the same, a TCP relay of its own), or an
  /// LCM URL (a process for each role there).
  std::string transport = "udpm";
  /// Event log to write. Empty: a temporary one, or with direct none at all.
  std::filesystem::path log;
  /// What is in the log already, if the run is to go on with it.
  std::optional<Resumption> resume;
  double pace = 0;                       // simulated seconds per second; 0: as fast as it goes
  bool realtime = false;                 // at that pace by the wall clock, whoever keeps up
  std::vector<Role> external;            // roles that somebody else starts
  Duration wait = milliseconds(60'000);  // for these to be ready; 0: for ever
  Duration stall_limit = milliseconds(4000);
  int restarts = 10;  // of each role that is killed or hangs; 0: that ends the run
  /// Whether to compute the roles' steps again from the log, and compare. Unsaid: with roles that
  /// are started elsewhere, and for a run that goes on.
  std::optional<bool> verify;
  bool same_build = false;  // end the run if a role is of another build than the runner's
  TrafficOptions traffic;
  bool announce = false;         // say on stderr where the run is and which processes take part
  bool samples = false;          // keep those of every step in the result
  std::string command_to_go_on;  // for the user, if the run ends early
};

/// How often a process was started again.
struct Restarts {
  std::string role;  // or "relay", the run's own
  int count;
  std::string last;  // how the last one before the present one ended
};

struct ExperimentResult {
  std::int64_t seed = 0;
  std::string transport;
  std::int64_t steps = 0;
  std::string digest;
  double wall_s = 0;
  std::int64_t repairs = 0;  // requests to publish something again
  Refusals refused{};
  std::vector<SendTrouble> send_troubles;
  std::vector<Stranger> strangers;  // of other runs, on the same network
  std::vector<Restarts> restarts;
  std::vector<OtherBuild> other_builds;  // roles that are not of the runner's build
  std::optional<Verification> verification;
  bool checked = true;        // the log is in all its bytes what the recorder has told
  std::filesystem::path log;  // empty if there is none
  RunMeasures measures;
  std::vector<FollowerMeasures> followers;  // nearest to the host first
  std::vector<Sample> samples;              // if they were wanted
  std::optional<RealtimeFigures> realtime;  // of a run in real time
};

/// Makes every part of a run once, without running it: fields that are each within their range may
/// not go together, and that should be told before any process is started.
/// @param file as which the scenario is known to the user
/// @throws ScenarioError with the rule "impossible"
void CheckPossible(const Scenario& scenario, const std::filesystem::path& file);

/// Runs a scenario to its end and reads the result from its log.
/// @throws InputError for a transport or log that cannot be, Interrupted after Ctrl-C,
///     std::runtime_error with one line that names the culprit when the run fails; a log stays
///     readable
ExperimentResult RunExperiment(const Scenario& scenario, const ExperimentOptions& options);

/// A run as its log tells it.
struct LoggedRun : RunLog {
  ExperimentResult result;
};
/// With the samples of all its steps. @throws InputError
LoggedRun ReadLoggedRun(const std::filesystem::path& log);
/// Without them, in memory that does not grow with the run.
/// @param scenario that is in the log
/// @throws InputError
LoggedRun MeasureLoggedRun(const std::filesystem::path& log, const Scenario& scenario);

}  // namespace fogline
