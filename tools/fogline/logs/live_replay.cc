#include "tools/fogline/logs/live_replay.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/exit_code.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/text.h"
#include "scenario/io/loader.h"
#include "services/runtime/transport/lcm_url.h"
#include "services/runtime/transport/traffic_options.h"
#include "services/runtime/wire/scenario_parts.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/logs/log_reading.h"
#include "tools/cli/logs/new_log.h"
#include "tools/cli/measures/run_text.h"
#include "tools/cli/run_outcome.h"
#include "tools/cli/transport_arguments.h"
#include "tools/replay/live/live_roles.h"
#include "tools/replay/live/track_difference.h"
#include "tools/runner/scenario_run.h"

namespace fogline {
namespace {

/// The scenario of the recorded run, with the overrides. It has no step after the end of the log.
/// @throws InputError
Scenario LiveScenario(const std::filesystem::path& log, const replay::RecordedMessages& messages,
                      const std::vector<std::string>& overrides) {
  const log::RunLog& run = messages.run();
  Scenario scenario = ParseScenario(run.scenario_text, PathText(log), overrides);
  if (std::abs(scenario.step_s - run.scenario.step_s) > 0) {
    throw InputError(
        "error: --set /step_s: it cannot change, because the recorded messages have the steps of "
        "their run");
  }
  scenario.steps = std::min(scenario.steps, messages.steps());
  if (scenario.steps < 1) cli::RefuseLog(log, "the log has no step");
  if (scenario.person.drives) {
    cli::RefuseLog(log,
                   "a person drove in this run: give --set /person/drives=false; with --channels "
                   "DRIVER_COMMAND the commands of the person then come from the log");
  }
  runner::CheckPossible(scenario, log);
  return scenario;
}

nlohmann::ordered_json TrackJson(const replay::TrackDifference& track) {
  nlohmann::ordered_json json{{"compared_steps", track.compared},
                              {"valid_in_one", track.valid_in_one},
                              {"not_in_both", track.not_in_both}};
  for (const replay::StateDifference& state : track.states) {
    nlohmann::ordered_json row{{"largest", nullptr}, {"step", nullptr}, {"rms", nullptr}};
    if (state.step >= 0) {
      row = {{"largest", state.largest}, {"step", state.step}, {"rms", state.rms}};
    }
    json[std::string(state.name)] = std::move(row);
  }
  return json;
}

std::string TrackText(const replay::TrackDifference& track) {
  std::string text = fmt::format("TRACK compared in {} steps", track.compared);
  if (track.valid_in_one > 0) text += fmt::format("; valid in only one: {}", track.valid_in_one);
  if (track.not_in_both > 0) text += fmt::format("; in only one log: {}", track.not_in_both);
  text += '\n';
  for (const replay::StateDifference& state : track.states) {
    if (state.step < 0) continue;
    text += fmt::format("  {:<20} largest {:.6g} (step {}), RMS {:.6g}\n", state.name,
                        state.largest, state.step, state.rms);
  }
  return text;
}

}  // namespace

LiveReplay::LiveReplay(CLI::App& verb) {
  CLI::Option* live = verb.add_flag(
      "--live", live_, "Make a run in which recorded messages replace the roles that sent them");
  const auto add = [&]<class T>(const char* name, T& value, const char* what) {
    return verb.add_option(name, value, what)->needs(live);
  };
  add("--channels", channels_, "Channels whose messages come from the log, separated by commas")
      ->capture_default_str();
  add("--set", overrides_, "Override a field of the log's scenario (repeatable)")
      ->allow_extra_args(false);
  add("--log", log_, "Event log of the new run (default: logs/NAME-N.lcm)");
  verb.add_flag("--force", force_, "Replace this log if it exists")->needs(live);
  add("--transport", transport_,
      "udpm, tcpq or an LCM URL (default: $LCM_DEFAULT_URL, if set, else udpm)");
  CLI::Option* realtime =
      verb.add_flag("--realtime", realtime_,
                    "Run on the wall clock; messages that the log lacks are missing in the run")
          ->needs(live);
  add("--speed", speed_, "Simulated seconds per second (default: that of the log, else 1)")
      ->check(cli::NumberIn(runtime::kMinSpeed, runtime::kMaxSpeed))
      ->needs(realtime);
  verb.add_flag("--quiet", quiet_, "Print only errors on stderr")->needs(live);
}

void LiveReplay::ChooseTransport(runner::RunOptions& options) const {
  options.transport = transport_.empty() ? "udpm" : transport_;
  if (!transport_.empty()) return;
  const auto url = runtime::UrlOfEnvironment();
  if (!url) return;
  options.transport_source = "LCM_DEFAULT_URL";
  runtime::CheckUrl(options.transport_source, *url);
  options.transport = *url;
}

int LiveReplay::Run(const std::filesystem::path& recorded, std::optional<std::int64_t> recorded_run,
                    bool json) const {
  std::error_code missing;
  if (!log_.empty() && std::filesystem::equivalent(log_, recorded, missing)) {
    throw InputError(
        fmt::format("{}: error: --log: this is the recorded log; the new run needs "
                    "another file",
                    PathText(log_)));
  }
  const log::ReadOptions read{.gaps = true, .run_id = recorded_run};
  const replay::RecordedMessages messages(recorded, read, replay::RecordedChannels(channels_));
  const log::RunLog& run = messages.run();
  if (const std::string gap = messages.FirstGap(); !realtime_ && !gap.empty()) {
    cli::RefuseLog(recorded,
                   fmt::format("{}: a run in lockstep needs every message; use --realtime", gap));
  }
  const Scenario scenario = LiveScenario(recorded, messages, overrides_);
  runner::RunOptions options;
  ChooseTransport(options);
  options.traffic = runtime::WithKeyOfEnvironment({});
  runtime::Check(options.traffic);
  cli::RequireProcesses(options, "a live replay");
  if (realtime_) {
    const double of_log = run.realtime ? run.realtime->speed : 1;
    const double speed = speed_ > 0 ? speed_ : of_log;
    cli::RunInRealtime(options, speed);
    cli::CheckPeriod(scenario, speed);
  }
  replay::LiveRoles roles(messages, options.traffic, realtime_);
  options.external = roles.roles();
  options.verify = false;  // recorded roles compute nothing, so they cannot be checked
  options.on_run = [&roles](std::int64_t run_id, const std::string& url) {
    roles.Join(run_id, url);
  };
  log::LogGuard log = log_.empty() ? cli::FreshLog(recorded) : cli::PrepareLog(log_, force_);
  options.log = log.path();
  options.on_logged_step = [&log] { log.RemoveOlder(); };
  WatchInterrupts();
  if (!quiet_) {
    Notice(fmt::format("replays {} of run {} in {} steps", channels_, run.run_id, scenario.steps));
  }
  const runner::RunResult result = runner::RunScenario(scenario, options);
  const replay::TrackDifference track = replay::CompareTracks(recorded, read, options.log);
  if (json) {
    nlohmann::ordered_json document{{"log", recorded.string()},
                                    {"live_log", options.log.string()},
                                    {"channels", nlohmann::ordered_json::array()},
                                    {"transport", options.transport},
                                    {"steps", result.steps},
                                    {"digest", result.digest},
                                    {"track", TrackJson(track)}};
    for (const std::size_t channel : messages.channels()) {
      document["channels"].push_back(kChannels[channel].name);
    }
    if (result.realtime) document["realtime"] = cli::RealtimeJson(*result.realtime);
    cli::PrintJson(document);
  } else {
    fmt::print("{}{}log    {}\n", TrackText(track),
               result.realtime ? cli::RealtimeText(*result.realtime) : "", PathText(options.log));
  }
  cli::SayAboutLog(recorded, run);
  // The recorded roles do not publish the messages that the recorded log lacks, but their STATUS
  // counts these steps. So it is not known whether the new log lacks messages.
  if (!run.complete) return kCheckFailed;
  return cli::EndOf(result, "replay");
}

}  // namespace fogline
