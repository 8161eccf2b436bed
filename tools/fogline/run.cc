// fogline run: one run of a scenario.
#include <cstdio>
#include <memory>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "tools/fogline/arguments.h"
#include "tools/fogline/experiment.h"
#include "tools/fogline/help.h"
#include "tools/fogline/interrupt.h"
#include "tools/fogline/transport_arguments.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

constexpr const char* kExamples =
    R"(Every run writes an LCM event log (logs/SCENARIO-N.lcm unless --log says
otherwise; direct writes one only with --log). Ctrl-C ends a run cleanly, keeps
its log, and gives exit code 130. A process that is killed or hangs is started
again and catches up, and the result is the same. A run has a port of its own
unless LCM_DEFAULT_URL names another; fogline top, spy, doctor and roles without
--lcm-url find it on this machine.

Examples:
  fogline run scenario/paper.json
  fogline run scenario/paper.json --set /arbitrator/threshold=0.8 --seed 7
  fogline run scenario/paper.json --pace 1       in real speed, for fogline top or spy
  fogline run scenario/paper.json --transport memq --json
  fogline run scenario/paper.json --faults loss=0.3,duplicate=0.1,reorder=0.1,delay_ms=5
  fogline-driver & fogline run scenario/paper.json --external driver
  fogline run scenario/paper.json --external driver --lcm-url 'udpm://239.255.76.67:7700?ttl=0')";

// A step of 0.1 s then takes 100 s.
constexpr double kMinPace = 1e-3;
// Nine processes must pass on a step in this time, and their signs of life be heard in 64 steps.
constexpr double kMinPeriodS = 0.005;

struct RunArguments {
  explicit RunArguments(CLI::App& verb) : scenario(verb), transport(verb, "udpm") {
    verb.add_option("--log", options.log, "Event log to write");
    verb.add_flag("--force", force, "Replace the log if it exists");
    verb.add_option("--pace", options.pace,
                    "Slow the lockstep down to so many simulated seconds per second (0: no limit)")
        ->check(NumberIn(0, 1000))
        ->capture_default_str();
    CLI::Option* realtime = verb.add_flag(
        "--realtime", options.realtime,
        "Tick on the wall clock and wait for no process: inputs that fail are noticed by their "
        "age, and another driver takes over or the car stops");
    verb.add_option("--speed", speed, "With --realtime: simulated seconds per second")
        ->check(NumberIn(kMinPace, 1000))
        ->needs(realtime)
        ->capture_default_str();
    verb.add_option("--stall-timeout", stall_s,
                    "End the run when no step completes for so long, in s")
        ->check(NumberIn(1, 1e6))
        ->capture_default_str();
    verb.add_option(
            "--restarts", options.restarts,
            "Start a role that is killed, or says nothing for 2 s (1 s with --realtime, never "
            "more than half of --stall-timeout), again: at most so often in the run (0: its "
            "death ends the run)")
        ->check(CLI::Range(0, 1'000'000))
        ->capture_default_str();
    verb.add_flag("--json", json, "Print the result as JSON");
    verb.add_flag("--quiet", quiet, "Say nothing on stderr but errors");
    ShowExitCodes(verb, {.interruptible = true});
    verb.footer(kExamples);
  }

  ScenarioArguments scenario;
  TransportArguments transport;
  ExperimentOptions options;
  double speed = 1.0;
  double stall_s = 4.0;
  bool force = false;
  bool json = false;
  bool quiet = false;
};

std::string ToJson(const std::filesystem::path& scenario, const ExperimentResult& result) {
  nlohmann::ordered_json json;
  json["scenario"] = scenario.string();
  json["seed"] = result.seed;
  json["transport"] = result.transport;
  json["steps"] = result.steps;
  json["digest"] = result.digest;
  json["wall_s"] = result.wall_s;
  json["log"] = nullptr;
  if (!result.log.empty()) json["log"] = result.log.string();
  json["repairs"] = result.repairs;
  for (std::size_t i = 0; i < kRefusals.size(); ++i) {
    json["refused"][std::string(kRefusals[i].key)] = result.refused[i];
  }
  json["failed_sends"] = nlohmann::ordered_json::array();
  for (const SendTrouble& one : result.send_troubles) {
    json["failed_sends"].push_back(
        {{"role", one.role}, {"count", one.count}, {"error", one.error}});
  }
  json["strangers"] = nlohmann::ordered_json::array();
  for (const Stranger& stranger : result.strangers) {
    json["strangers"].push_back({{"role", stranger.role},
                                 {"pid", stranger.pid},
                                 {"host", stranger.host},
                                 {"run_id", stranger.run_id}});
  }
  json["restarts"] = nlohmann::ordered_json::array();
  for (const Restarts& role : result.restarts) {
    json["restarts"].push_back({{"role", role.role}, {"count", role.count}, {"last", role.last}});
  }
  if (result.realtime) json["realtime"] = RealtimeJson(*result.realtime);
  json["metrics"] = nlohmann::ordered_json::parse(MeasuresJson(result));
  return json.dump(2);
}

/// @throws InputError if real time cannot go together with the other options
void ApplyRealtime(RunArguments& arguments) {
  ExperimentOptions& options = arguments.options;
  if (options.transport == "direct" || options.transport.starts_with("memq")) {
    throw InputError(fmt::format(
        "error: --realtime: --transport {} is one process; real time needs one for each role",
        options.transport));
  }
  if (options.pace != 0) {
    throw InputError("error: --pace: slows the lockstep down; with --realtime it is --speed");
  }
  options.pace = arguments.speed;
}

int Run(RunArguments& arguments) {
  ExperimentOptions& options = arguments.options;
  arguments.transport.Apply(options);
  const bool direct = options.transport == "direct";
  if (!(options.pace == 0 || options.pace >= kMinPace)) {
    throw InputError(
        fmt::format("error: --pace {}: neither 0 nor from {} to 1000", options.pace, kMinPace));
  }
  if (direct && options.pace != 0) {
    throw InputError("error: --pace: a run with --transport direct has no pace");
  }
  if (options.realtime) ApplyRealtime(arguments);
  options.stall_limit = duration_cast<Duration>(std::chrono::duration<double>(arguments.stall_s));
  options.announce = !arguments.quiet;
  const Scenario scenario = arguments.scenario.Load();
  if (const double period_s = scenario.step_s / arguments.speed;
      options.realtime && period_s < kMinPeriodS) {
    throw InputError(fmt::format(
        "error: --speed {:g}: a step of {:g} s would take {:.3g} ms of wall clock, at least {:g}",
        arguments.speed, scenario.step_s, 1e3 * period_s, 1e3 * kMinPeriodS));
  }
  if (!options.log.empty()) {
    PrepareLog(options.log, arguments.force);
  } else if (!direct) {
    options.log = FreshLog(arguments.scenario.file());
  }
  const LogOfRun log(options.log);
  WatchInterrupts();
  const ExperimentResult result = RunExperiment(scenario, options);
  if (arguments.json) {
    PrintJson(ToJson(arguments.scenario.file(), result));
    return kDone;
  }
  fmt::print("{}: {} steps in {:.2f} s over {}, {} repairs\n", arguments.scenario.file().string(),
             result.steps, result.wall_s, result.transport, result.repairs);
  std::string refused;
  for (std::size_t i = 0; i < kRefusals.size(); ++i) {
    if (result.refused[i] == 0) continue;
    refused +=
        fmt::format("{}{} {}", refused.empty() ? "" : ", ", result.refused[i], kRefusals[i].what);
  }
  if (!refused.empty()) fmt::print("refused messages: {}\n", refused);
  if (!result.send_troubles.empty()) {
    fmt::print("messages that could not be sent: {}\n", Text(result.send_troubles));
  }
  for (const Restarts& role : result.restarts) {
    fmt::print("{} was started again {}: {}\n", role.role,
               role.count == 1 ? "once" : fmt::format("{} times", role.count), role.last);
  }
  if (result.realtime) fmt::print("{}", RealtimeText(*result.realtime));
  fmt::print("digest {}\n", result.digest);
  if (!result.log.empty()) fmt::print("log    {}\n", result.log.string());
  fmt::print("{}", MeasuresText(result));
  return kDone;
}

}  // namespace

void AddRun(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand("run", "Run a scenario, one process for each role");
  const auto arguments = std::make_shared<RunArguments>(*verb);
  verb->callback([&action, arguments] { action = [arguments] { return Run(*arguments); }; });
}

}  // namespace fogline
