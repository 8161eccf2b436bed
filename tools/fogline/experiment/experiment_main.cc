// fogline experiment, a separate program: trials with people. Each trial has its own log.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
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
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/own_program.h"
#include "tools/cli/verb_program.h"
#include "tools/fogline/experiment/experiment_actions.h"
#include "tools/trials/tables.h"

namespace fogline {
namespace {

constexpr const char* kExperimentExamples =
    R"(An experiment is a JSON file: conditions (a scenario and changes of it), participants
(numbers, no names), practice runs, breaks and questionnaires. Each trial is a run in
real time with a log of its own, RESULTS/participant-03/trial-2-fog.lcm. The log has
participant, trial, condition, seed, markers and answers.

`fogline experiment ACTION --help` explains an action, with examples.

Examples:
  fogline experiment check scenario/experiment/thresholds.json
  fogline experiment run scenario/experiment/thresholds.json --participant 3
  fogline experiment status scenario/experiment/thresholds.json
  fogline experiment export scenario/experiment/thresholds.json --out tables)";

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
  arguments.plan.RequireResults();
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
        "log, the answers as QUESTIONNAIRE.ITEM, and the measures of the run (fogline metrics),\n"
        "also those of its first request to take over (first_request_...).\n"
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
  arguments.plan.RequireResults();
  const trials::Results results(plan, arguments.plan.results());
  WatchInterrupts();
  const trials::Tables tables = trials::MakeTables(plan, results);
  const OutputFolder folder(arguments.out, "--out");
  AtomicFiles files;
  files.Add(rows).Write(tables.trials);
  files.Add(values).Write(tables.values);
  files.Finish();
  fmt::print("{}\n{}\n", PathText(rows), PathText(values));
  for (const std::string& fault : tables.faults) Complain(EscapeControls(fault));
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
  if (arguments.schema && !arguments.files.empty()) {
    throw InputError("error: --schema: a FILE has no effect on it");
  }
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

void AddExperiment(CLI::App& app, cli::Action& action) {
  CLI::App* experiment = app.add_subcommand(cli::kExperiment.verb, cli::kExperiment.purpose);
  experiment->require_subcommand(1);
  AddCheckPlans(*experiment, action);
  AddRunTrials(*experiment, action);
  AddStatus(*experiment, action);
  AddExportTables(*experiment, action);
  cli::ShowExitCodes(*experiment, {.check_failed = "a trial is not done", .interruptible = true});
  experiment->footer(kExperimentExamples);
}

}  // namespace
}  // namespace fogline

int main(int argc, char** argv) {
  return fogline::cli::RunOneVerb(argc, argv, fogline::AddExperiment);
}
