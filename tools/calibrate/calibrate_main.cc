// The program of the verb `fogline calibrate`. The table of a scenario has SI (safety improvement)
// and RHE (redundant human engagement) for each threshold. The program finds the values of chosen
// fields (--free) with which this table is nearest to a target table. With --ensemble it finds
// several sets of values with which the table is near enough to the target table (--within).
#include <memory>
#include <optional>
#include <system_error>
#include <vector>

#include <fmt/core.h>

#include "common/atomic_file.h"
#include "common/file.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/process/progress.h"
#include "common/process/shell_word.h"
#include "common/text.h"
#include "scenario/io/diagnostic_list.h"
#include "scenario/io/json.h"
#include "tools/calibrate/calibrate.h"
#include "tools/calibrate/ensemble/ensemble.h"
#include "tools/calibrate/ensemble/ensemble_files.h"
#include "tools/calibrate/ensemble/ensemble_report.h"
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
    verb.add_option("--evaluations", evaluations,
                    "Largest number of tables to compute; with --ensemble, from each start")
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
    verb.add_flag("--steady", steady,
                  "Derive the gaps and /acc/standstill_m, so that each run begins in equilibrium");
    verb.add_option("--out", out,
                    "Write the scenario with the values that were found; with --ensemble, the "
                    "folder for the scenarios");
    verb.add_flag("--force", force, "Replace the file of --out if it is a scenario");
    verb.add_flag("--json", json, "Print as JSON");
    AddEnsemble(verb);
    cli::ShowExitCodes(verb, {.check_failed = "too few sets", .interruptible = true});
    verb.footer(
        "Minimises a weighted sum: the squared differences of mean SI and mean RHE from the\n"
        "target, in points, and SI's variance over the seeds. Equal arguments give equal\n"
        "results. Ctrl-C ends the search with the best values so far. Sensitivity is the\n"
        "change, in points, for 1 % of a field's range.\n\n"
        "With --ensemble N it finds N sets of values that are far from each other. A set meets\n"
        "the target if the root of the sum is at most --within, over --seeds and over --fresh.\n"
        "It writes FOLDER/set-1.json and so on, and FOLDER/sets.csv. Ctrl-C ends the search;\n"
        "the sets that are found by then are written.\n\n"
        "Examples:\n"
        "  fogline calibrate scenario/paper.json --free /fog/bias_m=0.2:0.5\n"
        "  fogline calibrate scenario/paper.json --free /radar/bias_m=0.92:0.98 \\\n"
        "    --free /follower/weight_distance=0.001:10:log --seeds 1:40 --out found.json\n"
        "  fogline table other.json --json > other-table.json\n"
        "  fogline calibrate scenario/paper.json --target other-table.json \\\n"
        "    --free /fog/bias_m=0.2:0.5 --json\n"
        "  fogline calibrate scenario/paper.json --ensemble 8 --out sets --steady \\\n"
        "    --free /fog/bias_m=0.15:0.3 --free /radar/bias_m=0.9:0.98 \\\n"
        "    --free /acc/headway_s=1:1.8");
  }

  void AddEnsemble(CLI::App& verb) {
    CLI::Option* const sets =
        verb.add_option("--ensemble", rules.sets,
                        "Find this number of distinct sets of values that all meet the target")
            ->check(CLI::Range(1, 1000));
    const auto add = [&](const char* name, auto& value, const char* description) {
      return verb.add_option(name, value, description)->needs(sets)->capture_default_str();
    };
    add("--fresh", fresh, "Seeds A:B, not among --seeds, over which each set is confirmed");
    add("--within", rules.within, "Largest distance from the target, in points, that meets it")
        ->check(cli::NumberIn(1e-6, 1e6));
    add("--apart", rules.apart,
        "Least distance of two sets: the root mean square of the differences of their fields, each "
        "as a share of its range")
        ->check(cli::NumberIn(0, 1));
    add("--starts", rules.starts, "Number of points from which a search may begin")
        ->check(CLI::Range(1, 100'000));
    add("--search-seed", rules.seed, "Seed of these points")
        ->check(CLI::Range(std::int64_t{0}, std::int64_t{1'000'000'000}));
    ensemble = sets;
  }

  bool wants_ensemble() const { return ensemble->count() > 0; }

  std::filesystem::path scenario;
  std::vector<std::string> free;
  std::filesystem::path target;
  std::vector<std::string> overrides;
  std::string seeds = "1:20";
  int evaluations = 1000;
  double rhe_weight = CalibrationProblem().rhe_weight;
  double spread_weight = CalibrationProblem().spread_weight;
  int jobs = sweep::AllCores();
  bool steady = false;
  std::filesystem::path out;
  bool force = false;
  bool json = false;
  CLI::Option* ensemble = nullptr;
  EnsembleRules rules;
  std::string fresh = "1001:1200";
};

CalibrationProblem MakeProblem(const CalibrateArguments& arguments) {
  cli::RefuseOverride(arguments.overrides, "/seed", "the seeds are those of --seeds");
  CalibrationProblem problem{.file = PathText(arguments.scenario),
                             .scenario = LoadScenario(arguments.scenario, arguments.overrides),
                             .fields = ParseFreeFields(arguments.free),
                             .target = {},
                             .seeds = cli::ReadSeeds(arguments.seeds),
                             .rhe_weight = arguments.rhe_weight,
                             .spread_weight = arguments.spread_weight,
                             .steady = arguments.steady,
                             .jobs = arguments.jobs};
  for (const FreeField& field : problem.fields) {
    if (!sweep::IsOfRecording(problem.scenario, field.pointer())) continue;
    throw InputError(
        fmt::format("error: --free {}: {}", field.pointer(), sweep::kRecordingIsReadOnce));
  }
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

/// Whether a file looks like a scenario: a JSON object with a version. The scenario's values may be
/// invalid.
bool IsScenario(const std::filesystem::path& file) {
  const FileText read = ReadFile(file, kMaxFileBytes);
  DiagnosticList diagnostics;
  const std::optional<JsonValue> root = ParseJson(read.text, 0, diagnostics);
  const auto* object = root ? root->As<JsonObject>() : nullptr;
  return object != nullptr && FindMember(*object, "version") != nullptr;
}

/// The text of the scenario file, with the overrides, for a new file in `folder`. Relative paths in
/// the text are changed, so that they lead to the same files from `folder`. Everything else is
/// unchanged.
std::string TextIn(const std::filesystem::path& folder, const CalibrateArguments& arguments,
                   const Scenario& scenario) {
  namespace fs = std::filesystem;
  const FileText read = ReadFile(arguments.scenario, kMaxFileBytes);
  if (!read.error.empty()) {
    throw InputError(fmt::format("{}: error: --out: {} {}", PathText(arguments.out),
                                 PathText(arguments.scenario), read.error));
  }
  std::string text = read.text;
  for (const std::string& one : arguments.overrides) text = WithOverride(text, one);
  const fs::path from = fs::absolute(arguments.scenario).parent_path();
  text = WithSchemaIn(folder, from, std::move(text));
  const auto move_path = [&](const char* pointer, const fs::path& file) {
    if (file.empty() || file.is_absolute()) return;
    text = WithValue(text, pointer, Quote(fs::proximate(from / file, folder).string()));
  };
  const LeadSection& lead = scenario.lead;
  if (lead.profile == LeadProfile::kRecorded) move_path("/lead/recorded/file", lead.recorded.file);
  if (lead.profile == LeadProfile::kSumo) {
    move_path("/lead/sumo/net_file", lead.sumo.net_file);
    move_path("/lead/sumo/route_file", lead.sumo.route_file);
  }
  return text;
}

/// Checks before the search that the result can be written. @return TextIn() for the result's
/// folder
std::string PrepareOut(const CalibrateArguments& arguments, const Scenario& scenario) {
  RefuseToReplace(arguments.out, "--out", arguments.force, "scenario", IsScenario);
  RequireWritable(arguments.out, "--out");
  // stdout and pipes have no folder. For them, relative paths in the text start from the current
  // folder.
  const std::filesystem::path folder = IsReplaceable(arguments.out)
                                           ? std::filesystem::absolute(arguments.out).parent_path()
                                           : std::filesystem::current_path();
  return TextIn(folder, arguments, scenario);
}

void WriteOut(const std::filesystem::path& file, std::string text, const Objective& objective,
              const std::vector<double>& values) {
  for (const FieldValue& change : objective.Changes(values)) {
    text = WithValue(text, change.pointer, NumberText(change.value));
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
    WriteOut(arguments.out, text, objective, found.values);
  }
  if (WasInterrupted()) {
    throw Interrupted(fmt::format("interrupted; these are the best values of {} evaluation{}",
                                  found.evaluations, found.evaluations == 1 ? "" : "s"));
  }
  return kDone;
}

/// The command that finds the same ensemble again, with FOLDER for the folder of the new files. It
/// omits options that do not change the ensemble.
std::string CommandOf(const CalibrateArguments& arguments) {
  std::string command = fmt::format("fogline calibrate {}", ShellWord(arguments.scenario.string()));
  const auto add = [&](std::string_view option, const auto& value) {
    command += fmt::format(" {} {}", option, ShellWord(fmt::format("{}", value)));
  };
  if (!arguments.target.empty()) add("--target", arguments.target.string());
  for (const std::string& one : arguments.overrides) add("--set", one);
  add("--ensemble", arguments.rules.sets);
  if (arguments.steady) command += " --steady";
  add("--seeds", arguments.seeds);
  add("--fresh", arguments.fresh);
  add("--within", arguments.rules.within);
  add("--apart", arguments.rules.apart);
  add("--starts", arguments.rules.starts);
  add("--evaluations", arguments.evaluations);
  add("--search-seed", arguments.rules.seed);
  const CalibrationProblem defaults;
  if (arguments.rhe_weight != defaults.rhe_weight) add("--rhe-weight", arguments.rhe_weight);
  if (arguments.spread_weight != defaults.spread_weight) {
    add("--spread-weight", arguments.spread_weight);
  }
  for (const std::string& one : arguments.free) add("--free", one);
  return command + " --out FOLDER";
}

ParameterEnsemble SearchEnsemble(const Objective& searched, const Objective& fresh,
                                 const EnsembleRules& rules) {
  Progress progress("set", rules.sets);
  int said = 0;
  return FindEnsemble(
      searched, fresh, rules, [] { return !WasInterrupted(); },
      [&](int found, const EnsembleCounts& counts) {
        if (found > said) {
          said = found;
          progress.Say(fmt::format("set {} of {} is found", found, rules.sets));
        }
        progress.Show(
            found, counts.searches == 0
                       ? fmt::format("start {}/{}", counts.evaluations, rules.starts)
                       : fmt::format("search {}, table {}", counts.searches, counts.evaluations));
      });
}

int RunEnsemble(const CalibrateArguments& arguments) {
  if (arguments.out.empty()) throw InputError("error: --ensemble: needs --out FOLDER");
  const Objective searched(MakeProblem(arguments));
  const Objective fresh(WithFreshSeeds(searched.problem(), cli::ReadSeeds(arguments.fresh)));
  EnsembleRules rules = arguments.rules;
  rules.evaluations = arguments.evaluations;
  EnsembleReport report{.searched = searched,
                        .fresh = fresh,
                        .rules = rules,
                        .found = {},
                        .scenario = arguments.scenario.string(),
                        .command = CommandOf(arguments)};
  const EnsembleFolder folder(arguments.out, arguments.force);
  const std::string text =
      TextIn(std::filesystem::absolute(arguments.out), arguments, searched.problem().scenario);
  // Finds mistakes in the scenario's text before the long search, not after it.
  ParseScenario(WithOrigin(report, 0, text), SetFileName(0));
  WatchInterrupts();
  report.found = SearchEnsemble(searched, fresh, rules);
  if (arguments.json) {
    cli::PrintJson(EnsembleJson(report));
  } else {
    fmt::print("{}", EnsembleText(report));
  }
  if (!report.found.sets.empty()) folder.Write(report, text);
  if (report.found.interrupted) {
    throw Interrupted(fmt::format("interrupted; {} of {} sets were found{}",
                                  report.found.sets.size(), rules.sets,
                                  report.found.sets.empty() ? "" : " and are written"));
  }
  if (static_cast<int>(report.found.sets.size()) == rules.sets) return kDone;
  Complain(
      fmt::format("fogline calibrate: only {} of {} sets were found; more --starts or "
                  "--evaluations, or other bounds, may give more",
                  report.found.sets.size(), rules.sets));
  return kCheckFailed;
}

void AddCalibrate(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand(cli::kCalibrate.verb, cli::kCalibrate.purpose);
  const auto arguments = std::make_shared<CalibrateArguments>(*verb);
  verb->callback([&action, arguments] {
    const auto run = arguments->wants_ensemble() ? RunEnsemble : RunCalibrate;
    action = [arguments, run] { return run(*arguments); };
  });
}

}  // namespace
}  // namespace fogline::calibrate

int main(int argc, char** argv) {
  return fogline::cli::RunOneVerb(argc, argv, fogline::calibrate::AddCalibrate);
}
