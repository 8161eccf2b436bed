// fogline experiment run: the trials of one participant.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/file_lock.h"
#include "common/interrupt.h"
#include "common/text.h"
#include "services/runtime/transport/tcpq_url.h"
#include "services/runtime/wire/step_ring.h"
#include "tools/cli/transport_arguments.h"
#include "tools/drive/evdev_device.h"
#include "tools/drive/terminal_keys.h"
#include "tools/fogline/experiment/experiment_actions.h"
#include "tools/runner/scenario_run.h"
#include "tools/trials/desk/page_desk.h"
#include "tools/trials/desk/terminal_desk.h"
#include "tools/trials/results.h"
#include "tools/trials/session.h"
#include "tools/web/server/page.h"

namespace fogline {
namespace {

constexpr const char* kRunExamples =
    R"(Makes the trials of a participant that are not done, in the participant's order. No log
is ever overwritten. After a crash or Ctrl-C the same command goes on: a run that broke
off is made again in a new log (trial-2-fog-attempt-2.lcm), and if only answers are
missing, only the questions are asked.

It prints two addresses: the page of the participant, which begins the runs and asks the
questions and shows neither condition nor threshold, and the page of the experimenter,
which shows the condition and takes markers: texts that go into the log of the run. Each
address has a token of its own. Only this machine can open the pages, unless --listen
names an address for others. With --no-page the questions are asked in the terminal. Each
line of stdin is then an answer, so a script can answer.

If a condition has /person/drives=true, the participant drives in it: the page of the
participant opens the seat (fogline drive --help), the run begins when the participant is
ready there, and after the run the page comes back with the questions. In every other
condition the model of a driver drives. With --keys or --evdev a person at this machine
drives in all conditions.

Examples:
  fogline experiment run scenario/experiment/lead_times.json --participant 1
  fogline experiment run scenario/experiment/lead_times.json --participant 1 --listen 192.168.1.5
  fogline experiment run scenario/experiment/thresholds.json --participant 3
  fogline experiment run scenario/experiment/thresholds.json --participant 3 --keys
  fogline experiment run scenario/experiment/thresholds.json --participant 3 --no-page --speed 10 \
    --results rehearsal
  fogline experiment run scenario/experiment/thresholds.json --participant 3 --no-page < answers.txt)";

struct RunTrialsArguments {
  explicit RunTrialsArguments(CLI::App& verb) : plan(verb), transport(verb, "udpm") {
    verb.add_option("--participant", participant, "Number of the participant, from 1 on")
        ->required();
    verb.add_option("--speed", speed, "Simulated seconds per second, instead of the file's")
        ->check(cli::NumberIn(runtime::kMinSpeed, runtime::kMaxSpeed));
    CLI::Option* terminal =
        verb.add_flag("--no-page", no_page, "Ask in the terminal instead of a page");
    verb.add_option("--listen", listen,
                    "ADDRESS of this machine at which others may open the pages, too")
        ->excludes(terminal);
    const auto add_port = [&](const char* name, std::uint16_t& port, const char* what) {
      verb.add_option(name, port, what)->check(CLI::Range(0, 65535))->excludes(terminal);
    };
    add_port("--participant-port", participant_port,
             "Port of the participant's page (default 0: any free port)");
    add_port("--experimenter-port", experimenter_port, "Port of the experimenter's page");
    add_port("--seat-port", seat_port,
             "Port of the seat and of the view; a browser keeps the calibration of a device for "
             "this port");
    CLI::Option* by_keys =
        verb.add_flag("--keys", keys, "A person drives with the terminal's keys");
    verb.add_option("--evdev", device, "A person drives with this input device")->excludes(by_keys);
    verb.add_flag("--no-breaks", no_breaks, "Leave out the breaks, to try the experiment");
    cli::ShowExitCodes(verb, {.done = "all trials are done", .interruptible = true});
    verb.footer(kRunExamples);
  }

  PlanArguments plan;
  cli::TransportArguments transport;
  std::int64_t participant = 0;
  std::optional<double> speed;
  std::uint16_t participant_port = 0;
  std::uint16_t experimenter_port = 0;
  std::uint16_t seat_port = 0;
  std::string listen;
  std::string device;
  bool keys = false;
  bool no_page = false;
  bool no_breaks = false;
};

/// @throws InputError
trials::SessionOptions SessionOf(const RunTrialsArguments& arguments, const ExperimentPlan& plan) {
  if (arguments.participant < 1 || arguments.participant > plan.participants) {
    throw InputError(fmt::format("error: --participant {}: the experiment has participants 1 to {}",
                                 arguments.participant, plan.participants));
  }
  trials::SessionOptions options{.participant = arguments.participant,
                                 .speed = arguments.speed.value_or(plan.speed),
                                 .overrides = {},
                                 .breaks = !arguments.no_breaks,
                                 .pedals = {},
                                 .run = {}};
  if (arguments.keys) {
    options.pedals = [](const PersonSection& person) {
      return std::make_unique<drive::TerminalKeys>(person);
    };
  } else if (!arguments.device.empty()) {
    options.pedals = [device = arguments.device](const PersonSection& person) {
      return std::make_unique<drive::EvdevDevice>(device, drive::DeviceNames(), person);
    };
  }
  if (options.pedals) options.overrides.push_back("/person/drives=true");
  arguments.transport.Apply(options.run);
  cli::RequireProcesses(options.run, "a trial");
  return options;
}

/// The first condition of the experiment in which the participant drives; nullptr if there is none.
const ConditionSection* DrivenCondition(const trials::PlanFile& plan) {
  for (const auto* list : {&plan.plan.practice, &plan.plan.conditions}) {
    for (const ConditionSection& condition : *list) {
      if (trials::LoadCondition(plan, condition).person.drives) return &condition;
    }
  }
  return nullptr;
}

/// If the participant drives in a condition, checks that the participant has a page, keys or a
/// device for driving.
/// @throws InputError if --no-page is given without keys or device; std::runtime_error if this
///     build has no page
void CheckSeat(const RunTrialsArguments& arguments, const trials::PlanFile& plan) {
  const std::string no_page(web::WhyNoPage());
  const bool has_seat = !arguments.no_page && no_page.empty();
  if (has_seat || arguments.keys || !arguments.device.empty()) return;
  const ConditionSection* driven = DrivenCondition(plan);
  if (driven == nullptr) return;
  if (!arguments.no_page) {
    throw std::runtime_error(fmt::format("in condition {} the participant drives at a page, but {}",
                                         Quote(driven->name), no_page));
  }
  throw InputError(fmt::format(
      "error: --no-page: in condition {} the participant drives; leave out --no-page, or give "
      "--keys or --evdev",
      Quote(driven->name)));
}

/// Checks that all trials can be made at the speed of the session, also if a person drives with
/// --keys or --evdev. @throws InputError
void CheckSpeed(const RunTrialsArguments& arguments, const trials::PlanFile& plan,
                const trials::SessionOptions& options) {
  for (const auto* list : {&plan.plan.practice, &plan.plan.conditions}) {
    for (const ConditionSection& condition : *list) {
      const Scenario scenario = trials::LoadCondition(plan, condition, options.overrides);
      const std::string why = trials::WhyNotAt(options.speed, scenario);
      if (why.empty()) continue;
      if (arguments.speed) {
        throw InputError(fmt::format("error: --speed {}: in condition {}: {}",
                                     NumberText(options.speed), Quote(condition.name), why));
      }
      // The file's speed fits the conditions in the file. It may not fit the person who drives with
      // --keys or --evdev.
      throw InputError(
          fmt::format("error: {}: {}, but /speed of {} is {}; give --speed 1",
                      arguments.keys ? "--keys" : "--evdev " + PathText(arguments.device), why,
                      PathText(plan.file), NumberText(options.speed)));
    }
  }
}

/// @throws InputError if two pages have the same port
void CheckPorts(const RunTrialsArguments& arguments) {
  const std::array<std::pair<const char*, std::uint16_t>, 3> ports{
      {{"--participant-port", arguments.participant_port},
       {"--experimenter-port", arguments.experimenter_port},
       {"--seat-port", arguments.seat_port}}};
  for (std::size_t i = 0; i < ports.size(); ++i) {
    for (std::size_t k = i + 1; k < ports.size(); ++k) {
      if (ports[i].second == 0 || ports[i].second != ports[k].second) continue;
      throw InputError(fmt::format("error: {} {}: {} has the same port", ports[k].first,
                                   ports[k].second, ports[i].first));
    }
  }
}

/// If a trial of the participant needs a run, opens the device and the network of the session once.
/// So an error is found before a person waits for the run.
/// @throws InputError; std::runtime_error if the network cannot be reached
void CheckMeans(const ExperimentPlan& plan, const trials::Results& results,
                const trials::SessionOptions& options) {
  const auto needs_run = [&results](const trials::Trial& trial) {
    return results.Read(trial).NeedsRun();
  };
  if (std::ranges::none_of(trials::ScheduleOf(plan, options.participant), needs_run)) return;
  if (options.pedals) options.pedals(PersonSection());
  runner::CheckNetwork(options.run);
}

/// The numeric address of --listen; "" without --listen. @throws InputError
std::string ListenAddress(const RunTrialsArguments& arguments) {
  if (arguments.listen.empty()) return "";
  if (arguments.listen.find(':') != std::string::npos) {
    throw InputError(fmt::format(
        "error: --listen {}: an address without a port; --participant-port, --experimenter-port "
        "and --seat-port name the ports",
        EscapeControls(arguments.listen)));
  }
  return runtime::tcpq::ResolveOwn(arguments.listen, "--listen").address;
}

/// Begins to serve the pages. @throws InputError; std::runtime_error if a page cannot be served
std::unique_ptr<trials::PageDesk> ServePages(const RunTrialsArguments& arguments,
                                             const runtime::TrafficOptions& traffic) {
  return std::make_unique<trials::PageDesk>(
      trials::PageOptions{.listen = ListenAddress(arguments),
                          .participant_port = arguments.participant_port,
                          .experimenter_port = arguments.experimenter_port,
                          .seat_port = arguments.seat_port,
                          .traffic = traffic});
}

void PrintAddresses(const trials::PageDesk& pages) {
  fmt::print("participant: {}\nexperimenter: {}\n", pages.participant_address(),
             pages.experimenter_address());
  std::fflush(stdout);
}

int RunTrials(const RunTrialsArguments& arguments) {
  const trials::PlanFile plan = arguments.plan.Load();
  trials::SessionOptions options = SessionOf(arguments, plan.plan);
  CheckSpeed(arguments, plan, options);
  CheckSeat(arguments, plan);
  CheckPorts(arguments);
  const trials::Results results(plan, arguments.plan.results());
  // If another session has this participant, Begin() reports this. A later call of Begin() would be
  // too late: the pages would fail first, because the other session has their ports, too.
  std::error_code missing;
  const bool has_begun = std::filesystem::exists(results.FolderOf(arguments.participant), missing);
  auto lock = has_begun ? results.Begin(arguments.participant) : nullptr;
  CheckMeans(plan.plan, results, options);
  WatchInterrupts();
  const auto pages = arguments.no_page ? nullptr : ServePages(arguments, options.run.traffic);
  // Begin() makes the folder of a new participant. Before this line, the first session of a
  // participant has written nothing. The addresses are printed only if the session can begin.
  if (!lock) lock = results.Begin(arguments.participant);
  if (pages) PrintAddresses(*pages);
  trials::TerminalDesk terminal;
  trials::Desk& desk = pages ? static_cast<trials::Desk&>(*pages) : terminal;
  const trials::SessionOutcome outcome =
      trials::RunSession(plan, results, std::move(options), desk);
  fmt::print("participant {}: all trials are done; {} runs now, in {}\n", arguments.participant,
             outcome.runs, PathText(results.FolderOf(arguments.participant)));
  return kDone;
}

}  // namespace

void AddRunTrials(CLI::App& experiment, cli::Action& action) {
  CLI::App* verb = experiment.add_subcommand("run", "Make the trials of a participant");
  const auto arguments = std::make_shared<RunTrialsArguments>(*verb);
  verb->callback([&action, arguments] { action = [arguments] { return RunTrials(*arguments); }; });
}

}  // namespace fogline
