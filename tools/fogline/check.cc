// fogline check: checks a scenario, prints it in full, and explains its fields.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/process/console.h"
#include "common/text.h"
#include "scenario/io/loader.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/fogline/verbs.h"
#include "tools/hosts/lab_file.h"
#include "tools/runner/scenario_run.h"

namespace fogline {
namespace {

struct CheckOptions {
  std::vector<std::string> files;
  std::vector<std::string> overrides;
  std::optional<std::string> explain;
  bool print = false;
  bool schema = false;
  bool lab = false;
  bool json = false;
};

nlohmann::ordered_json ToJson(const Diagnostic& diagnostic) {
  return {{"file", diagnostic.file},     {"line", diagnostic.line},
          {"column", diagnostic.column}, {"pointer", diagnostic.pointer},
          {"rule", diagnostic.rule},     {"message", diagnostic.message}};
}

/// Checks the file of a scenario or, with --lab, of a laboratory. Prints the scenario with --print,
/// nothing with --json, otherwise "FILE: ok".
/// @throws ScenarioError with the mistakes of the file
void CheckFile(const std::string& file, const CheckOptions& options) {
  if (options.lab) {
    hosts::LoadLab(file);
  } else {
    const Scenario scenario = LoadScenario(file, options.overrides);
    runner::CheckPossible(scenario, file);
    if (options.print) {
      fmt::print("{}", PrintScenario(scenario));
      return;
    }
  }
  if (!options.json) fmt::print("{}: ok\n", PathText(file));
}

int CheckFiles(const CheckOptions& options) {
  int code = kDone;
  nlohmann::ordered_json diagnostics = nlohmann::ordered_json::array();
  for (const std::string& file : options.files) {
    try {
      CheckFile(file, options);
    } catch (const ScenarioError& error) {
      code = kBadInput;
      for (const Diagnostic& diagnostic : error.diagnostics())
        diagnostics.push_back(ToJson(diagnostic));
      if (!options.json) Complain(error.what());
    }
  }
  if (options.json) cli::PrintJson(diagnostics);
  return code;
}

int Check(const CheckOptions& options) {
  const int modes = (options.print ? 1 : 0) + (options.schema ? 1 : 0) + (options.json ? 1 : 0) +
                    (options.explain ? 1 : 0);
  if (modes > 1) {
    throw InputError("error: --print, --schema, --explain and --json exclude each other");
  }
  if (options.lab && (options.print || options.explain || !options.overrides.empty())) {
    throw InputError("error: --lab: --print, --explain and --set are for scenarios");
  }
  if ((options.schema || options.explain) &&
      (!options.files.empty() || !options.overrides.empty())) {
    throw InputError(fmt::format("error: --{}: neither a FILE nor --set has an effect on it",
                                 options.schema ? "schema" : "explain"));
  }
  if (options.schema) {
    fmt::print("{}", options.lab ? LabSchema() : ScenarioSchema());
    return kDone;
  }
  if (options.explain) {
    fmt::print("{}", ExplainField(*options.explain));
    return kDone;
  }
  if (options.files.empty()) throw InputError("error: FILE is missing");
  if (options.print && options.files.size() > 1) {
    throw InputError("error: --print takes one FILE");
  }
  return CheckFiles(options);
}

}  // namespace

void AddCheck(CLI::App& app, cli::Action& action) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* verb = app.add_subcommand("check", "Validate scenario files, and explain their fields");
  verb->add_option("FILE", options->files, "Scenario files");
  verb->add_option("--set", options->overrides, "Override a field first (repeatable)")
      ->allow_extra_args(false)
      ->type_name("/POINTER=VALUE");
  verb->add_flag("--print", options->print, "Print the scenario with all its defaults");
  verb->add_flag("--schema", options->schema, "Print the JSON schema of scenarios");
  verb->add_option("--explain", options->explain, "Print a field's meaning, range, default")
      ->type_name("/POINTER");
  verb->add_flag("--lab", options->lab, "Check files of laboratories (run --lab)");
  verb->add_flag("--json", options->json, "Print mistakes as a JSON list");
  cli::ShowExitCodes(*verb, {.done = "every file is good"});
  verb->footer(
      "Prints `FILE: ok` for a good file; otherwise every mistake as\n"
      "`FILE:LINE:COLUMN: error: /pointer: ...` on stderr.\n\n"
      "Examples:\n"
      "  fogline check scenario/paper.json scenario/dense_fog.json\n"
      "  fogline check --print --set /arbitrator/threshold=0.8 scenario/paper.json\n"
      "  fogline check --explain /fog/visibility_m\n"
      "  fogline check --explain /\n"
      "  fogline check --lab lab.json");
  verb->callback([options, &action] { action = [options] { return Check(*options); }; });
}

}  // namespace fogline
