// fogline events: lists the times at which each side drove, the outcome of every request to take
// over, and every emergency braking. It reads only logs.
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
#include "services/log/run_log.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/measures/take_over_text.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

struct EventsArguments {
  std::vector<std::filesystem::path> logs;
  bool json = false;
};

struct RunEvents {
  log::RunLog run;
  take_over::TakeOverLog log;
  std::vector<metrics::TakeOverMeasures> measures;  // of log.requests()
};

RunEvents ReadEvents(const std::filesystem::path& file) {
  log::RunLogReader reader(file);
  RunEvents events;
  arbitration_t command{};
  driver_command_t driver{};
  while (const log::StepMessages* messages = reader.Next()) {
    const runtime::Bytes bytes = (*messages)[IndexOf<arbitration_t>()];
    if (bytes.empty() || !runtime::Decode(bytes, command)) continue;
    const runtime::Bytes offer = (*messages)[IndexOf<driver_command_t>()];
    const bool offered = !offer.empty() && runtime::Decode(offer, driver);
    events.log.Add(command, offered ? std::optional(driver.acceleration_mps2) : std::nullopt);
  }
  events.run = reader.run();
  if (!events.log.requests().empty()) {
    events.measures = runner::MeasureLoggedRun(file, events.run.scenario).result.take_overs;
  }
  return events;
}

// The name of a time of a request, and the time.
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

nlohmann::ordered_json EventsJson(const RunEvents& events) {
  auto rows = nlohmann::ordered_json::array();
  for (const take_over::TakeOverEntry& entry : events.log.entries()) {
    rows.push_back({{"step", entry.step},
                    {"time_s", static_cast<double>(entry.utime) / 1e6},
                    {"event", take_over::TextOf(entry, events.run.scenario.person)},
                    {"transfer", entry.transfer},
                    {"from", take_over::NameOfMode(entry.from)},
                    {"to", take_over::NameOfMode(entry.to)}});
  }
  return rows;
}

nlohmann::ordered_json RequestsJson(const RunEvents& events) {
  auto rows = nlohmann::ordered_json::array();
  for (const take_over::TakeOverRequest& request : events.log.requests()) {
    nlohmann::ordered_json row;
    for (const auto& [name, step] : TimesOf(request)) {
      const double time_s = static_cast<double>(step.value_or(0)) * events.run.scenario.step_s;
      row[fmt::format("{}_s", name)] = step ? nlohmann::ordered_json(time_s) : nullptr;
    }
    if (const auto* measures = MeasuresOf(events, request)) {
      row["measures"] = cli::TakeOverJson(*measures);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

void PrintText(const std::filesystem::path& file, const RunEvents& events) {
  fmt::print("{}: {}, seed {}\n", PathText(file), EscapeControls(events.run.scenario.title),
             events.run.scenario.seed);
  for (const take_over::TakeOverEntry& entry : events.log.entries()) {
    fmt::print("{:>8}{:>10.2f} s  {:<42}{}", entry.step, static_cast<double>(entry.utime) / 1e6,
               take_over::TextOf(entry, events.run.scenario.person),
               take_over::NameOfMode(entry.from));
    fmt::print("{}\n", entry.from == entry.to
                           ? ""
                           : fmt::format(" -> {}", take_over::NameOfMode(entry.to)));
  }
  int number = 0;
  for (const take_over::TakeOverRequest& request : events.log.requests()) {
    fmt::print("  request {}:", ++number);
    for (const auto& [name, step] : TimesOf(request)) {
      if (!step) continue;
      fmt::print(" {} {:.2f} s", name, static_cast<double>(*step) * events.run.scenario.step_s);
    }
    fmt::print("\n");
    if (const auto* measures = MeasuresOf(events, request)) {
      fmt::print("    {}\n", cli::TakeOverLine(*measures));
    }
  }
}

int RunEventsVerb(const EventsArguments& arguments) {
  auto rows = nlohmann::ordered_json::array();
  bool complete = true;
  const bool readable =
      cli::ForEachReadable(arguments.logs, [&](const std::filesystem::path& file) {
        const RunEvents events = ReadEvents(file);
        complete = complete && events.run.complete;
        if (!events.run.note.empty())
          Complain(fmt::format("{}: {}", PathText(file), events.run.note));
        if (arguments.json) {
          rows.push_back({{"log", file.string()},
                          {"title", events.run.scenario.title},
                          {"seed", events.run.scenario.seed},
                          {"complete", events.run.complete},
                          {"events", EventsJson(events)},
                          {"requests", RequestsJson(events)}});
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
  const auto arguments = std::make_shared<EventsArguments>();
  verb->add_option("LOG", arguments->logs, "Event logs")->required();
  verb->add_flag("--json", arguments->json, "Print as JSON");
  cli::ShowExitCodes(*verb, {.check_failed = "a log is not complete"});
  verb->footer(
      "Lists the events that a data recorder stores: changes of state, requests to take over\n"
      "and their escalation, acknowledgements, transfers, first effective inputs, manoeuvres,\n"
      "collision warnings and emergency braking.\n"
      "Then lists the times of each request, from the start of the run, and its outcome and\n"
      "measures (services/metrics/README.md defines them). With the mode instant\n"
      "of take_over the driver is not asked, so there are no requests and acknowledgements.\n\n"
      "Examples:\n"
      "  fogline run scenario/paper.json --set /arbitrator/take_over/mode=requested --log "
      "logs/asked.lcm\n"
      "  fogline events logs/asked.lcm\n"
      "  fogline events logs/*.lcm --json | jq '.[].requests[] | .transferred_s - .requested_s'");
  verb->callback(
      [&action, arguments] { action = [arguments] { return RunEventsVerb(*arguments); }; });
}

}  // namespace fogline
