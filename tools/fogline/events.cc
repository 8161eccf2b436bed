// fogline events: lists the times at which each side drove, the outcome of every request to take
// over, and every emergency braking. The verb reads only logs.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/process/console.h"
#include "common/text.h"
#include "services/decision/take_over/take_over_log.h"
#include "services/graph.h"
#include "services/log/run_log.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/logs/log_reading.h"
#include "tools/cli/measures/run_text.h"
#include "tools/cli/measures/take_over_text.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

struct EventsArguments {
  explicit EventsArguments(CLI::App& verb) : reading(verb) {}

  cli::LogReading reading;
  std::vector<std::filesystem::path> logs;
  bool json = false;
};

struct RunEvents {
  log::RunLog run;
  take_over::TakeOverLog log;
  std::vector<metrics::TakeOverMeasures> measures;  // of the requests in `log` that have measures
  std::string unknown;  // the requests without measures (UnknownTakeOvers())
};

RunEvents ReadEvents(const std::filesystem::path& file, const log::ReadOptions& options) {
  log::RunLogReader reader(file, options);
  RunEvents events;
  arbitration_t command{};
  driver_command_t driver{};
  while (const log::StepMessages* messages = reader.Next()) {
    if (reader.InTail()) continue;
    const runtime::Bytes bytes = (*messages)[IndexOf<arbitration_t>()];
    if (bytes.empty() || !runtime::Decode(bytes, command)) continue;
    const runtime::Bytes offer = (*messages)[IndexOf<driver_command_t>()];
    const bool offered = !offer.empty() && runtime::Decode(offer, driver);
    events.log.Add(command, offered ? std::optional(driver.acceleration_mps2) : std::nullopt);
  }
  events.run = reader.run();
  const bool has_command = !events.log.entries().empty();
  if (!events.log.requests().empty() || !events.run.complete || !has_command) {
    runner::LoggedRun measured = runner::MeasureLoggedRun(file, events.run.scenario, options);
    measured.result.lack.beginning_of_request |= events.log.BeganInRequest();
    events.unknown = cli::UnknownTakeOvers(measured);
    events.measures = std::move(measured.result.take_overs);
  }
  return events;
}

// The name of an event of a request, and the step of this event.
using RequestTime = std::pair<const char*, std::optional<std::int64_t>>;
std::array<RequestTime, 7> TimesOf(const take_over::TakeOverRequest& request) {
  return {{{"requested", request.requested},
           {"escalated", request.escalated},
           {"acknowledged", request.acknowledged},
           {"transferred", request.transferred},
           {"effective", request.effective},
           {"manoeuvre", request.manoeuvre},
           {"standstill", request.standstill}}};
}

/// The measures of a request; nullptr if the log lacks TRUTH in the step of the request.
const metrics::TakeOverMeasures* MeasuresOf(const RunEvents& events,
                                            const take_over::TakeOverRequest& request) {
  const double step_s = events.run.scenario.step_s;
  const auto found = std::ranges::find_if(events.measures, [&](const auto& measures) {
    return std::abs(measures.requested_s - static_cast<double>(request.requested) * step_s) <
           step_s / 2;
  });
  return found == events.measures.end() ? nullptr : &*found;
}

/// Those of the channels HOST_COMMAND and DRIVER_COMMAND on which the log may lack published
/// messages. The set is empty for a run in lockstep.
runtime::ChannelSet UnloggedCommands(const log::RunLog& run) {
  runtime::ChannelSet commands;
  commands.set(IndexOf<arbitration_t>()).set(IndexOf<driver_command_t>());
  return run.realtime ? commands & run.realtime->unlogged_channels : runtime::ChannelSet();
}

/// Whether an event may have happened before the step in which it is listed, because commands are
/// missing. In real time a step of a complete log may have no command. So in real time the result
/// is true only if the log may lack published messages.
bool MayBeEarlier(const RunEvents& events, const take_over::TakeOverEntry& entry) {
  return entry.earliest_step != entry.step &&
         (!events.run.realtime || UnloggedCommands(events.run).any());
}

/// Whether an event of this step may have happened before the step.
bool MayBeEarlier(const RunEvents& events, std::int64_t step) {
  return std::ranges::any_of(events.log.entries(), [&](const take_over::TakeOverEntry& entry) {
    return entry.step == step && MayBeEarlier(events, entry);
  });
}

nlohmann::ordered_json EventsJson(const RunEvents& events) {
  auto rows = nlohmann::ordered_json::array();
  for (const take_over::TakeOverEntry& entry : events.log.entries()) {
    rows.push_back({{"step", entry.step},
                    {"time_s", static_cast<double>(entry.utime) / 1e6},
                    {"event", take_over::TextOf(entry, events.run.scenario.person)},
                    {"transfer", entry.transfer},
                    {"from", take_over::NameOfMode(entry.from)},
                    {"to", take_over::NameOfMode(entry.to)}});
    if (MayBeEarlier(events, entry)) rows.back()["earliest_step"] = entry.earliest_step;
  }
  return rows;
}

nlohmann::ordered_json RequestsJson(const RunEvents& events) {
  auto rows = nlohmann::ordered_json::array();
  for (const take_over::TakeOverRequest& request : events.log.requests()) {
    nlohmann::ordered_json row;
    auto earlier = nlohmann::ordered_json::array();
    for (const auto& [name, step] : TimesOf(request)) {
      if (step && MayBeEarlier(events, *step)) earlier.push_back(fmt::format("{}_s", name));
      const std::int64_t step_us = std::llround(events.run.scenario.step_s * kMicrosPerSecond);
      const double time_s = static_cast<double>(step.value_or(0) * step_us) / kMicrosPerSecond;
      row[fmt::format("{}_s", name)] = step ? nlohmann::ordered_json(time_s) : nullptr;
    }
    if (const auto* measures = MeasuresOf(events, request)) {
      row["measures"] = cli::TakeOverJson(*measures);
    }
    if (!earlier.empty()) row["may_be_earlier"] = std::move(earlier);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string ModesText(const take_over::TakeOverEntry& entry) {
  const std::string_view from = take_over::NameOfMode(entry.from);
  if (entry.from == entry.to) return std::string(from);
  return fmt::format("{} -> {}", from, take_over::NameOfMode(entry.to));
}

/// The step of an event, and its line in the list.
using EventLine = std::pair<std::int64_t, std::string>;

/// Adds a line for each fallback of a run in real time.
void AddFallbacks(const log::RunLog& run, std::vector<EventLine>& lines) {
  if (!run.realtime) return;
  for (const runtime::Fallback& fallback : run.realtime->fallbacks) {
    std::string text = fmt::format("fallback: {}: {}", fallback.role, fallback.what);
    if (!fallback.culprit.empty()) {
      text +=
          fmt::format(" (culprit: {}, last heard {:.2f} s ago)", fallback.culprit, fallback.age_s);
    }
    lines.emplace_back(fallback.step, std::move(text));
  }
}

/// Adds a line for each gap in HOST_COMMAND or DRIVER_COMMAND. In a gap it is unknown which side
/// drove, or whether an input of the driver was effective.
void AddGaps(const log::LogGaps& gaps, std::vector<EventLine>& lines) {
  for (const log::Gap& gap : gaps.gaps) {
    if (!gap.channels[IndexOf<arbitration_t>()] && !gap.channels[IndexOf<driver_command_t>()]) {
      continue;
    }
    lines.emplace_back(gap.first, fmt::format("unknown: {}", gap.Text()));
  }
}

/// The lines of the events in HOST_COMMAND, of gaps and of fallbacks, in the order of their steps.
std::vector<EventLine> LinesOf(const RunEvents& events) {
  std::vector<EventLine> lines;
  AddGaps(events.run.gaps, lines);
  if (const runtime::ChannelSet commands = UnloggedCommands(events.run); commands.any()) {
    lines.emplace_back(0, fmt::format("unknown: the log may lack published messages of {}",
                                      log::NamesOfChannels(commands)));
  }
  for (const take_over::TakeOverEntry& entry : events.log.entries()) {
    std::string text = fmt::format("{:<42}{}", take_over::TextOf(entry, events.run.scenario.person),
                                   ModesText(entry));
    if (MayBeEarlier(events, entry)) text += log::InOneOfTheSteps(entry.earliest_step, entry.step);
    lines.emplace_back(entry.step, std::move(text));
  }
  AddFallbacks(events.run, lines);
  std::ranges::stable_sort(lines, {}, &EventLine::first);
  return lines;
}

void PrintText(const std::filesystem::path& file, const RunEvents& events) {
  fmt::print("{}: {}, seed {}\n", PathText(file), EscapeControls(events.run.scenario.title),
             events.run.scenario.seed);
  for (const auto& [step, text] : LinesOf(events)) {
    const double time_s = static_cast<double>(step) * events.run.scenario.step_s;
    fmt::print("{:>8}{:>10.2f} s  {}\n", step, time_s, text);
  }
  if (events.run.realtime && events.run.realtime->priority) {
    fmt::print("{}", cli::PriorityText(*events.run.realtime->priority));
  }
  int number = 0;
  for (const take_over::TakeOverRequest& request : events.log.requests()) {
    fmt::print("  request {}:", ++number);
    for (const auto& [name, step] : TimesOf(request)) {
      if (!step) continue;
      fmt::print(" {} {:.2f} s{}", name, static_cast<double>(*step) * events.run.scenario.step_s,
                 MayBeEarlier(events, *step) ? " or before" : "");
    }
    fmt::print("\n");
    if (const auto* measures = MeasuresOf(events, request)) {
      fmt::print("    {}\n", cli::TakeOverLine(*measures));
    }
  }
}

/// Prints on stderr what a log lacks, and which results are unknown for this reason.
void SayAbout(const std::filesystem::path& file, const RunEvents& events) {
  cli::SayAboutLog(file, events.run);
  if (events.unknown.empty()) return;
  Complain(
      fmt::format("{}: unknown, because messages are missing: {}", PathText(file), events.unknown));
}

nlohmann::ordered_json ToJson(const std::filesystem::path& file, const RunEvents& events) {
  nlohmann::ordered_json json{{"log", file.string()},
                              {"title", events.run.scenario.title},
                              {"seed", events.run.scenario.seed},
                              {"complete", events.run.complete},
                              {"events", EventsJson(events)},
                              {"requests", RequestsJson(events)}};
  if (events.run.gaps.Any()) json["gaps"] = cli::GapsJson(events.run.gaps);
  if (!events.unknown.empty()) json["unknown_take_overs"] = events.unknown;
  if (events.run.realtime) {
    const nlohmann::ordered_json figures = cli::RealtimeJson(*events.run.realtime);
    for (const char* key : {"fallbacks", "fallbacks_left_out", "priority"}) {
      if (figures.contains(key)) json[key] = figures[key];
    }
  }
  return json;
}

int RunEventsVerb(const EventsArguments& arguments) {
  const log::ReadOptions options = arguments.reading.Options();
  auto rows = nlohmann::ordered_json::array();
  bool complete = true;
  const bool readable =
      cli::ForEachReadable(arguments.logs, [&](const std::filesystem::path& file) {
        const RunEvents events = ReadEvents(file, options);
        complete = complete && events.run.complete;
        SayAbout(file, events);
        if (arguments.json) {
          rows.push_back(ToJson(file, events));
        } else {
          PrintText(file, events);
        }
      });
  if (arguments.json) cli::PrintJson(rows);
  if (!readable) return kBadInput;
  return complete ? kDone : kCheckFailed;
}

}  // namespace

void AddEvents(CLI::App& app, cli::Action& action) {
  CLI::App* verb =
      app.add_subcommand("events", "List which side drove when, and every request to take over");
  const auto arguments = std::make_shared<EventsArguments>(*verb);
  verb->add_option("LOG", arguments->logs, "Event logs")->required();
  verb->add_flag("--json", arguments->json, "Print as JSON");
  cli::ShowExitCodes(*verb, {.check_failed = "a log is not complete"});
  verb->footer(
      "Lists the events that a data recorder stores: changes of state, requests to take over\n"
      "and their escalation, acknowledgements, transfers, first effective inputs, manoeuvres,\n"
      "collision warnings and emergency braking. In a run in real time it also lists the\n"
      "fallbacks of the roles. If the log lacks commands of the host or the driver, the list\n"
      "says so, in lockstep with their steps. An event after such a gap may have happened in\n"
      "the gap: the list gives the steps, JSON has earliest_step, and may_be_earlier with the\n"
      "times of a request.\n"
      "If the log lacks the beginning of the run, the list begins with the state in the first\n"
      "command of the log.\n"
      "Then lists the times of each request, from the start of the run, and its outcome and\n"
      "measures (services/metrics/README.md defines them). With the mode instant\n"
      "of take_over the human is not asked, so there are no requests and acknowledgements.\n\n"
      "Examples:\n"
      "  fogline run scenario/paper.json --set /arbitrator/take_over/mode=requested --log "
      "logs/asked.lcm\n"
      "  fogline events logs/asked.lcm\n"
      "  fogline events logs/*.lcm --json | jq '.[].requests[] | select(.transferred_s) |\n"
      "    .transferred_s - .requested_s'");
  verb->callback(
      [&action, arguments] { action = [arguments] { return RunEventsVerb(*arguments); }; });
}

}  // namespace fogline
