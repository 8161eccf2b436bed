// fogline calibrate, a program of its own: finds those values of fields with which a scenario's
// table is nearest to a target table.
#include <memory>
#include <optional>
#include <system_error>

#include <fmt/core.h>

#include "common/atomic_file.h"
#include "common/file.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/process/progress.h"
#include "common/text.h"
#include "scenario/io/diagnostic_list.h"
#include "scenario/io/json.h"
#include "tools/calibrate/calibrate.h"
#include "tools/calibrate/fit.h"
#include "tools/calibrate/scenario_text.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/own_program.h"
#include "tools/cli/verb_program.h"
#include "tools/sweep/engine.h"
#include "tools/sweep/threshold_curve.h"

namespace fogline::calibrate {
namespace {

struct CalibrateArguments {
  explicit CalibrateArguments(CLI::App& verb) {
    verb.add_option("SCENARIO", scenario, "Scenario file")->required();
    verb.add_option("--free", free,
                    "Field to find and its bounds, /pointer=lowest:highest; :log at its end: "
                    "logarithmic scale (repeatable)")
        ->required()
        ->allow_extra_args(false);
    verb.add_option(
        "--target", target,
        "Target table, from `fogline table --json` (default: the scenario's published rows)");
    verb.add_option("--set", overrides, "Override a field: /steps=310 (repeatable)")
        ->allow_extra_args(false);
    verb.add_option("--seeds", seeds, "Seeds A:B, both included, of every evaluation")
        ->capture_default_str();
    verb.add_option("--evaluations", evaluations, "Largest number of tables to compute")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    verb.add_option("--rhe-weight", rhe_weight, "Weight of RHE; the weight of SI is 1")
        ->check(cli::NumberIn(0, 1e6))
        ->capture_default_str();
    verb.add_option("--spread-weight", spread_weight, "Weight of SI's variance over the seeds")
        ->check(cli::NumberIn(0, 1e6))
        ->capture_default_str();
    verb.add_option("--jobs", jobs, "Threads; the result does not depend on them")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    verb.add_option("--out", out, "Write the scenario with the values that were found");
    verb.add_flag("--force", force, "Replace the file of --out if it is a scenario");
    verb.add_flag("--json", json, "Print as JSON");
    cli::ShowExitCodes(verb, {.interruptible = true});
    verb.footer(
        "Minimises a weighted sum: the squared differences of mean SI and mean RHE from the\n"
        "target, in points, and SI's variance over the seeds. Equal arguments give equal\n"
        "results. Ctrl-C ends the search with the best values so far. Sensitivity is the\n"
        "change, in points, for 1 % of a field's range.\n\n"
        "Examples:\n"
        "  fogline calibrate scenario/paper.json --free /fog/bias_m=0.2:0.5\n"
        "  fogline calibrate scenario/paper.json --free /radar/bias_m=0.92:0.98 \\\n"
        "    --free /follower/weight_distance=0.001:10:log --seeds 1:40 --out found.json\n"
        "  fogline table other.json --json > other-table.json\n"
        "  fogline calibrate scenario/paper.json --target other-table.json \\\n"
        "    --free /fog/bias_m=0.2:0.5 --json");
  }

  std::filesystem::path scenario;
  std::vector<std::string> free;
  std::filesystem::path target;
  std::vector<std::string> overrides;
  std::string seeds = "1:20";
  int evaluations = 1000;
  double rhe_weight = CalibrationProblem().rhe_weight;
  double spread_weight = CalibrationProblem().spread_weight;
  int jobs = sweep::AllCores();
  std::filesystem::path out;
  bool force = false;
  bool json = false;
};

CalibrationProblem MakeProblem(const CalibrateArguments& arguments) {
  CalibrationProblem problem{.file = PathText(arguments.scenario),
                             .scenario = LoadScenario(arguments.scenario, arguments.overrides),
                             .fields = ParseFreeFields(arguments.free),
                             .target = {},
                             .seeds = cli::ReadSeeds(arguments.seeds),
                             .rhe_weight = arguments.rhe_weight,
                             .spread_weight = arguments.spread_weight,
                             .jobs = arguments.jobs};
  sweep::RequireThreshold(problem.scenario, arguments.scenario);
  problem.target =
      arguments.target.empty() ? PublishedTarget(problem.scenario) : ReadTarget(arguments.target);
  if (problem.target.empty()) {
    throw InputError(
        fmt::format("{}: error: /published: no rows, so there is no target; give a --target",
                    PathText(arguments.scenario)));
  }
  return problem;
}

/// Whether a file has the form of a scenario; its values may be invalid.
bool IsScenario(const std::filesystem::path& file) {
  const FileText read = ReadFile(file, kMaxFileBytes);
  DiagnosticList diagnostics;
  const std::optional<JsonValue> root = ParseJson(read.text, 0, diagnostics);
  const auto* object = root ? root->As<JsonObject>() : nullptr;
  return object != nullptr && FindMember(*object, "version") != nullptr;
}

/// Checks before the search that its result can be written. @return the text of the scenario file
/// with the overrides in it and everything else unchanged
std::string PrepareOut(const CalibrateArguments& arguments, const Scenario& scenario) {
  namespace fs = std::filesystem;
  const auto refuse = [&](std::string_view why) {
    throw InputError(fmt::format("{}: error: --out: {}", PathText(arguments.out), why));
  };
  RefuseToReplace(arguments.out, "--out", arguments.force, "scenario", IsScenario);
  const fs::path folder = fs::absolute(arguments.out).parent_path();
  RequireWritable(arguments.out, "--out");
  const FileText read = ReadFile(arguments.scenario, kMaxFileBytes);
  if (!read.error.empty()) refuse(fmt::format("{} {}", PathText(arguments.scenario), read.error));
  std::string text = read.text;
  for (const std::string& one : arguments.overrides) text = WithOverride(text, one);
  // The path of a recorded leader's file is relative to the scenario's folder.
  const fs::path recorded = scenario.lead.recorded.file;
  if (scenario.lead.profile == LeadProfile::kRecorded && !recorded.empty() &&
      recorded.is_relative()) {
    const fs::path there = fs::absolute(arguments.scenario).parent_path() / recorded;
    text = WithValue(text, "/lead/recorded/file", Quote(fs::proximate(there, folder).string()));
  }
  return text;
}

void WriteOut(const std::filesystem::path& file, std::string text,
              const CalibrationProblem& problem, const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    text = WithValue(text, problem.fields[i].pointer(), NumberText(values[i]));
  }
  ParseScenario(text, file.string());
  AtomicFile out(file);
  out.Write(text);
  out.Finish();
  Notice(fmt::format("{}: written", PathText(file)));
}

/// @throws Interrupted if the interrupt came before the first result
Findings Search(const CalibrateArguments& arguments, const Objective& objective) {
  const auto go_on = [] { return !WasInterrupted(); };
  std::optional<Calibration> found;
  {
    Progress progress("evaluation", arguments.evaluations);
    found = Calibrate(objective, arguments.evaluations, go_on, [&](int evaluations, double best) {
      if (evaluations == 1) Notice(fmt::format("objective at the start: {:.4g}", best));
      progress.Show(evaluations, fmt::format("objective {:.4g}", best));
    });
  }
  if (!found) throw Interrupted("interrupted before the first evaluation was complete");
  Findings findings{.calibration = *std::move(found), .sensitivities = std::nullopt};
  if (!findings.calibration.interrupted) {
    findings.sensitivities = Sensitivities(objective, findings.calibration.values, go_on);
  }
  return findings;
}

int RunCalibrate(const CalibrateArguments& arguments) {
  cli::RefuseJsonBeside(arguments.out, "--out", arguments.json);
  const Objective objective(MakeProblem(arguments));
  const std::string text =
      arguments.out.empty() ? "" : PrepareOut(arguments, objective.problem().scenario);
  WatchInterrupts();
  const Findings findings = Search(arguments, objective);
  const Calibration& found = findings.calibration;
  if (arguments.json) {
    cli::PrintJson(FindingsJson(objective.problem(), findings, arguments.scenario.string()));
  } else {
    cli::PrintBeside(arguments.out, FindingsText(objective.problem(), findings));
  }
  if (!arguments.out.empty()) {
    WriteOut(arguments.out, text, objective.problem(), found.values);
  }
  if (WasInterrupted()) {
    throw Interrupted(fmt::format("interrupted; these are the best values of {} evaluation{}",
                                  found.evaluations, found.evaluations == 1 ? "" : "s"));
  }
  return kDone;
}

void AddCalibrate(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand(cli::kCalibrate.verb, cli::kCalibrate.purpose);
  const auto arguments = std::make_shared<CalibrateArguments>(*verb);
  verb->callback(
      [&action, arguments] { action = [arguments] { return RunCalibrate(*arguments); }; });
}

}  // namespace
}  // namespace fogline::calibrate

int main(int argc, char** argv) {
  return fogline::cli::RunOneVerb(argc, argv, fogline::calibrate::AddCalibrate);
}
