// fogline experiment: trials with people, each with a log of its own.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/text.h"
#include "scenario/io/loader.h"
#include "services/runtime/wire/step_ring.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/transport_arguments.h"
#include "tools/drive/evdev_device.h"
#include "tools/drive/terminal_keys.h"
#include "tools/fogline/verbs.h"
#include "tools/trials/desk/page_desk.h"
#include "tools/trials/desk/terminal_desk.h"
#include "tools/trials/session.h"
#include "tools/trials/tables.h"

namespace fogline {
namespace {

constexpr const char* kExperimentExamples =
    R"(An experiment is a JSON file: conditions (a scenario and changes of it), participants
(numbers, no names), practice runs, breaks and questionnaires. Each trial is a run in
real time with a log of its own, RESULTS/participant-03/trial-2-fog.lcm. The log has
everything: participant, trial, condition, seed, markers and answers.

`fogline experiment ACTION --help` explains an action, with examples.

Examples:
  fogline experiment check scenario/experiment/thresholds.json
  fogline experiment run scenario/experiment/thresholds.json --participant 3
  fogline experiment status scenario/experiment/thresholds.json
  fogline experiment export scenario/experiment/thresholds.json --out tables)";

constexpr const char* kRunExamples =
    R"(Makes the trials of a participant that are not done, in the participant's order. No log
is ever overwritten. After a crash or Ctrl-C the same command goes on: a run that broke
off is made again in a new log (trial-2-fog-attempt-2.lcm), and if only answers are
missing, only the questions are asked.

It prints two addresses: the page of the participant, which begins the runs and asks the
questions and shows neither condition nor threshold, and the page of the experimenter,
which shows the condition and takes markers: texts that go into the log of the run. Both
are for browsers on this machine. With --no-page the questions are asked in the terminal.
Each line of stdin is then an answer, so a script can answer.

With --keys or --evdev a person at this machine drives the host (fogline drive --help);
without them the model of a driver does.

Examples:
  fogline experiment run scenario/experiment/thresholds.json --participant 3
  fogline experiment run scenario/experiment/thresholds.json --participant 3 --keys
  fogline experiment run scenario/experiment/thresholds.json --participant 3 --no-page --speed 10
  fogline experiment run scenario/experiment/thresholds.json --participant 3 --no-page < answers.txt)";

/// The arguments FILE and --results.
class PlanArguments {
 public:
  explicit PlanArguments(CLI::App& verb) {
    verb.add_option("FILE", file_, "File of the experiment")->required();
    verb.add_option("--results", results_, "Folder with the logs (default: logs/NAME-OF-FILE)");
  }

  trials::PlanFile Load() const { return trials::LoadPlan(file_); }
  std::filesystem::path results() const {
    return results_.empty() ? std::filesystem::path(kDefaultFolder) / file_.stem() : results_;
  }

 private:
  std::filesystem::path file_;
  std::filesystem::path results_;
};

// ---- run ---------------------------------------------------------------------------------------

struct RunTrialsArguments {
  explicit RunTrialsArguments(CLI::App& verb) : plan(verb), transport(verb, "udpm") {
    verb.add_option("--participant", participant, "Number of the participant, from 1 on")
        ->required();
    verb.add_option("--speed", speed, "Simulated seconds per second, instead of the file's")
        ->check(cli::NumberIn(runtime::kMinSpeed, runtime::kMaxSpeed));
    CLI::Option* terminal =
        verb.add_flag("--no-page", no_page, "Ask in the terminal instead of a page");
    const auto add_port = [&](const char* name, std::uint16_t& port, const char* what) {
      verb.add_option(name, port, what)->check(CLI::Range(0, 65535))->excludes(terminal);
    };
    add_port("--participant-port", participant_port,
             "Port of the participant's page (default 0: any free port)");
    add_port("--experimenter-port", experimenter_port, "Port of the experimenter's page");
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
  const std::string& transport = options.run.transport;
  if (transport == "direct" || transport.starts_with("memq")) {
    throw InputError(fmt::format(
        "error: --transport {}: is one process; a trial is in real time, with a process for each "
        "role",
        transport));
  }
  return options;
}

/// @throws std::runtime_error if a page cannot be served
std::unique_ptr<trials::Desk> MakeDesk(const RunTrialsArguments& arguments,
                                       const runtime::TrafficOptions& traffic) {
  if (arguments.no_page) return std::make_unique<trials::TerminalDesk>();
  auto desk = std::make_unique<trials::PageDesk>(
      trials::PageOptions{.participant_port = arguments.participant_port,
                          .experimenter_port = arguments.experimenter_port,
                          .traffic = traffic});
  fmt::print("participant: {}\nexperimenter: {}\n", desk->participant_address(),
             desk->experimenter_address());
  std::fflush(stdout);
  return desk;
}

int RunTrials(const RunTrialsArguments& arguments) {
  const trials::PlanFile plan = arguments.plan.Load();
  trials::SessionOptions options = SessionOf(arguments, plan.plan);
  const trials::Results results(plan, arguments.plan.results());
  WatchInterrupts();
  const auto desk = MakeDesk(arguments, options.run.traffic);
  const trials::SessionOutcome outcome =
      trials::RunSession(plan, results, std::move(options), *desk);
  fmt::print("participant {}: all trials are done; {} runs now, in {}\n", arguments.participant,
             outcome.runs, PathText(results.FolderOf(arguments.participant)));
  return kDone;
}

void AddRunTrials(CLI::App& experiment, cli::Action& action) {
  CLI::App* verb = experiment.add_subcommand("run", "Make the trials of a participant");
  const auto arguments = std::make_shared<RunTrialsArguments>(*verb);
  verb->callback([&action, arguments] { action = [arguments] { return RunTrials(*arguments); }; });
}

// ---- status ------------------------------------------------------------------------------------

struct StatusArguments {
  explicit StatusArguments(CLI::App& verb) : plan(verb) {
    verb.add_flag("--json", json, "Print as JSON");
    cli::ShowExitCodes(verb, {.done = "all trials of all participants are done",
                              .check_failed = "a trial is not done"});
    verb.footer(
        "States: open (not begun), broken (the run broke off), to_ask (answers are missing), "
        "done.\n"
        "\nExamples:\n"
        "  fogline experiment status scenario/experiment/thresholds.json\n"
        "  fogline experiment status scenario/experiment/thresholds.json --json");
  }

  PlanArguments plan;
  bool json = false;
};

nlohmann::ordered_json ToJson(const ExperimentPlan& plan, const trials::TrialRecord& record) {
  nlohmann::ordered_json row{{"trial", record.trial.number},
                             {"practice", record.trial.practice},
                             {"condition", trials::ConditionOf(plan, record.trial).name},
                             {"state", trials::NameOf(record.story.state)},
                             {"attempts", record.attempts}};
  row["log"] = record.attempts > 0 ? nlohmann::ordered_json(record.log.string()) : nullptr;
  row["note"] = record.story.note;
  return row;
}

void PrintParticipant(const ExperimentPlan& plan, std::int64_t participant,
                      const std::vector<trials::TrialRecord>& records) {
  fmt::print("participant {} ({})\n", participant, trials::OrderText(plan, participant));
  for (const trials::TrialRecord& record : records) {
    if (record.attempts == 0) continue;
    fmt::print("  {:<8} {:>2}  {:<16} {:<7} {}\n", record.trial.practice ? "practice" : "trial",
               record.trial.number, trials::ConditionOf(plan, record.trial).name,
               trials::NameOf(record.story.state), PathText(record.log));
    if (!record.story.note.empty()) fmt::print("    {}\n", EscapeControls(record.story.note));
  }
}

int PrintStatus(const StatusArguments& arguments) {
  const trials::PlanFile plan = arguments.plan.Load();
  const trials::Results results(plan, arguments.plan.results());
  nlohmann::ordered_json participants = nlohmann::ordered_json::array();
  std::int64_t done = 0;
  std::int64_t all = 0;
  for (std::int64_t number = 1; number <= plan.plan.participants; ++number) {
    const std::vector<trials::TrialRecord> records = results.ReadAll(number);
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const trials::TrialRecord& record : records) {
      ++all;
      if (record.story.state == trials::TrialState::kDone) ++done;
      rows.push_back(ToJson(plan.plan, record));
    }
    if (!arguments.json) PrintParticipant(plan.plan, number, records);
    participants.push_back({{"participant", number},
                            {"order", trials::OrderText(plan.plan, number)},
                            {"trials", std::move(rows)}});
  }
  if (arguments.json) {
    cli::PrintJson({{"title", plan.plan.title},
                    {"results", results.folder().string()},
                    {"done", done},
                    {"trials", all},
                    {"participants", std::move(participants)}});
  } else {
    fmt::print("{} of {} trials and practice runs are done\n", done, all);
  }
  return done == all ? kDone : kCheckFailed;
}

void AddStatus(CLI::App& experiment, cli::Action& action) {
  CLI::App* verb = experiment.add_subcommand("status", "Show which trials are done");
  const auto arguments = std::make_shared<StatusArguments>(*verb);
  verb->callback(
      [&action, arguments] { action = [arguments] { return PrintStatus(*arguments); }; });
}

// ---- export ------------------------------------------------------------------------------------

struct TablesArguments {
  explicit TablesArguments(CLI::App& verb) : plan(verb) {
    verb.add_option("--out", out, "Folder for trials.csv and values.csv")->required();
    verb.add_flag("--force", force, "Replace the tables of an earlier export");
    cli::ShowExitCodes(verb, {.check_failed = "a trial is not done"});
    verb.footer(
        "trials.csv has a row for each trial with a log: participant, trial, condition, order, "
        "seed,\n"
        "log, the answers as QUESTIONNAIRE.ITEM, and the measures of the run (fogline metrics).\n"
        "values.csv has a row for each answer, measure and marker: item, value, unit. Practice "
        "runs\n"
        "have practice 1. A trial without a log has no rows.\n\n"
        "Examples:\n"
        "  fogline experiment export scenario/experiment/thresholds.json --out tables\n"
        "  fogline experiment export scenario/experiment/thresholds.json --out tables --force");
  }

  PlanArguments plan;
  std::filesystem::path out;
  bool force = false;
};

int ExportTables(const TablesArguments& arguments) {
  const std::filesystem::path rows = arguments.out / "trials.csv";
  const std::filesystem::path values = arguments.out / "values.csv";
  for (const std::filesystem::path& file : {rows, values}) {
    RefuseToReplace(file, "--out", arguments.force, "table of an experiment", trials::IsTrialTable);
  }
  const trials::PlanFile plan = arguments.plan.Load();
  const trials::Results results(plan, arguments.plan.results());
  WatchInterrupts();
  const trials::Tables tables = trials::MakeTables(plan, results);
  const OutputFolder folder(arguments.out, "--out");
  AtomicFiles files;
  files.Add(rows).Write(tables.trials);
  files.Add(values).Write(tables.values);
  files.Finish();
  fmt::print("{}\n{}\n", PathText(rows), PathText(values));
  if (tables.missing == 0) return kDone;
  Complain(
      fmt::format("fogline experiment: {} trials and practice runs are not done", tables.missing));
  return kCheckFailed;
}

void AddExportTables(CLI::App& experiment, cli::Action& action) {
  CLI::App* verb = experiment.add_subcommand("export", "Write the trials as two CSV files");
  const auto arguments = std::make_shared<TablesArguments>(*verb);
  verb->callback(
      [&action, arguments] { action = [arguments] { return ExportTables(*arguments); }; });
}

// ---- check -------------------------------------------------------------------------------------

struct CheckPlanArguments {
  std::vector<std::filesystem::path> files;
  bool schema = false;
};

void PrintPlan(const trials::PlanFile& plan) {
  fmt::print("{}: ok\n", PathText(plan.file));
  for (std::int64_t number = 1; number <= plan.plan.participants; ++number) {
    fmt::print("  participant {}: {}\n", number, trials::OrderText(plan.plan, number));
  }
  const std::string remark = trials::BalanceRemark(plan.plan);
  if (!remark.empty()) fmt::print("  {}\n", remark);
}

int CheckPlans(const CheckPlanArguments& arguments) {
  if (arguments.schema) {
    fmt::print("{}", ExperimentSchema());
    return kDone;
  }
  if (arguments.files.empty()) throw InputError("error: FILE is missing");
  int code = kDone;
  for (const std::filesystem::path& file : arguments.files) {
    try {
      PrintPlan(trials::LoadPlan(file));
    } catch (const InputError& error) {
      Complain(error.what());
      code = kBadInput;
    }
  }
  return code;
}

void AddCheckPlans(CLI::App& experiment, cli::Action& action) {
  CLI::App* verb =
      experiment.add_subcommand("check", "Validate files of experiments, and print the orders");
  const auto arguments = std::make_shared<CheckPlanArguments>();
  verb->add_option("FILE", arguments->files, "Files of experiments");
  verb->add_flag("--schema", arguments->schema, "Print the JSON schema of such files");
  cli::ShowExitCodes(*verb, {.done = "every file is good"});
  verb->footer(
      "Also checks the scenario of each condition with its changes.\n\n"
      "Examples:\n"
      "  fogline experiment check scenario/experiment/thresholds.json\n"
      "  fogline experiment check --schema");
  verb->callback([&action, arguments] { action = [arguments] { return CheckPlans(*arguments); }; });
}

}  // namespace

void AddExperiment(CLI::App& app, cli::Action& action) {
  CLI::App* experiment =
      app.add_subcommand("experiment", "Make trials with people: orders, questions, tables");
  experiment->require_subcommand(1);
  AddCheckPlans(*experiment, action);
  AddRunTrials(*experiment, action);
  AddStatus(*experiment, action);
  AddExportTables(*experiment, action);
  cli::ShowExitCodes(*experiment, {.check_failed = "a trial is not done", .interruptible = true});
  experiment->footer(kExperimentExamples);
}

}  // namespace fogline
