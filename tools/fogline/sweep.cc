// fogline sweep: runs a scenario over a grid of fields and a range of seeds, on all cores.
#include <algorithm>
#include <memory>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/process/progress.h"
#include "common/text.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/fogline/verbs.h"
#include "tools/sweep/description.h"
#include "tools/sweep/merge.h"
#include "tools/sweep/row_sums.h"
#include "tools/sweep/sweep_csv.h"

namespace fogline {
namespace {

struct SweepArguments {
  explicit SweepArguments(CLI::App& verb) {
    verb.add_option("SCENARIO", scenario, "Scenario file");
    verb.add_option("--set", overrides, "Override a field in every run (repeatable)")
        ->allow_extra_args(false);
    verb.add_option("--grid", grid,
                    "Values of a field: /pointer=a,b,c or /pointer=first:last:count (repeatable)")
        ->allow_extra_args(false);
    verb.add_option("--seeds", seeds, "Seeds A:B, both included (default: the scenario's own)");
    verb.add_option("--jobs", jobs, "Threads")->check(CLI::Range(1, 1024))->capture_default_str();
    verb.add_option(
        "--out", out,
        "CSV file; a pipe or /dev/stdout gets only the rows (default: SCENARIO-sweep.csv in this "
        "folder; if that is of another sweep, SCENARIO-sweep-2.csv and so on)");
    verb.add_option("--shard", shard, "Compute only part I of N, as I/N (see below)");
    CLI::Option* put_together =
        verb.add_option("--merge", merge, "Join the files of all shards into --out");
    for (const char* other : {"SCENARIO", "--set", "--grid", "--seeds", "--shard"}) {
      put_together->excludes(other);
    }
    verb.add_flag("--force", force, "Replace the file even if it is of another sweep");
    verb.add_flag("--json", json, "Print runs, time and rate as JSON");
    cli::ShowExitCodes(verb, {.interruptible = true});
    verb.footer(
        "The order of the rows does not depend on --jobs. Call a stopped or killed sweep again to\n"
        "continue at the end of its file. FILE.json describes the sweep in FILE.\n"
        "SI compares each row with the same run without traded control.\n"
        "Rows that differ only in fields of /arbitrator/ are computed together, in one shard. So\n"
        "some shards may be empty.\n\n"
        "Examples:\n"
        "  fogline sweep scenario/paper.json --grid /arbitrator/threshold=0.2,0.5,0.8 --seeds "
        "1:1000\n"
        "  fogline sweep scenario/paper.json --grid /arbitrator/threshold=0.01:0.99:99 \\\n"
        "    --grid /fog/bias_m=0.2,0.3,0.4 --seeds 1:100 --out curves.csv\n"
        "  fogline sweep scenario/paper.json --seeds 1:1000 --shard 3/7 --out part3.csv\n"
        "  fogline sweep --merge part*.csv --out whole.csv");
  }

  std::filesystem::path scenario;
  std::vector<std::string> overrides;
  std::vector<std::string> grid;
  std::string seeds;
  int jobs = sweep::AllCores();
  std::filesystem::path out;
  std::string shard = "1/1";
  std::vector<std::filesystem::path> merge;
  bool force = false;
  bool json = false;
};

sweep::SweepPlan MakePlan(const SweepArguments& arguments) {
  if (arguments.scenario.empty()) throw InputError("error: SCENARIO is required");
  Scenario scenario = LoadScenario(arguments.scenario, arguments.overrides);
  std::vector<sweep::Axis> axes;
  for (const std::string& axis : arguments.grid) {
    axes.push_back(sweep::ParseAxis(axis));
    cli::RefuseOverride(arguments.overrides, axes.back().pointer, "the values are those of --grid");
  }
  if (!arguments.seeds.empty()) {
    cli::RefuseOverride(arguments.overrides, "/seed", "the seeds are those of --seeds");
  }
  const sweep::SeedRange seeds = arguments.seeds.empty()
                                     ? sweep::SeedRange{scenario.seed, scenario.seed}
                                     : cli::ReadSeeds(arguments.seeds);
  return sweep::SweepPlan(std::move(scenario), std::move(axes), seeds,
                          PathText(arguments.scenario));
}

std::string RowsText(std::int64_t rows) {
  return rows == 1 ? "1 row" : fmt::format("{} rows", rows);
}

/// Prints a summary on stdout, or on stderr if the rows go to stdout.
void PrintSummary(const std::filesystem::path& out, const std::string& text) {
  if (IsStdout(out)) return Complain(text);
  fmt::print("{}\n{}\n", text, PathText(out));
}

/// The default file for the rows: the file of the same sweep if there is one, otherwise a new file.
/// The file of another sweep is replaced only with --force.
std::filesystem::path DefaultOut(const SweepArguments& arguments, const sweep::SweepPlan& plan,
                                 const sweep::Shard& shard) {
  const std::string stem = arguments.scenario.stem().native() + "-sweep";
  const sweep::Description description = Describe(plan, shard);
  std::error_code missing;
  for (int number = 1;; ++number) {
    const std::filesystem::path out =
        number == 1 ? stem + ".csv" : fmt::format("{}-{}.csv", stem, number);
    if (arguments.force || std::filesystem::file_size(out, missing) == 0 || missing) return out;
    if (sweep::IsSweep(out) && sweep::ReadDescription(out) == description) return out;
  }
}

int Merge(const SweepArguments& arguments) {
  if (arguments.out.empty()) throw InputError("error: --merge needs --out");
  WatchInterrupts();
  const sweep::Merged merged = sweep::MergeShards(arguments.merge, arguments.out, arguments.force);
  nlohmann::ordered_json unchecked = nlohmann::ordered_json::array();
  for (const std::filesystem::path& shard : merged.unchecked) {
    Complain(fmt::format(
        "fogline sweep: warning: {}: the rows are not checked, because {} is missing or empty",
        PathText(shard), PathText(sweep::SumsFile(shard))));
    unchecked.push_back(shard.string());
  }
  if (arguments.json) {
    const nlohmann::ordered_json json{
        {"rows", merged.rows}, {"out", arguments.out.string()}, {"unchecked", unchecked}};
    cli::PrintJson(json);
  } else {
    PrintSummary(arguments.out, RowsText(merged.rows));
  }
  return kDone;
}

int RunSweepVerb(const SweepArguments& arguments) {
  cli::RefuseJsonBeside(arguments.out, "--out", arguments.json);
  if (!arguments.merge.empty()) return Merge(arguments);
  const sweep::SweepPlan plan = MakePlan(arguments);
  const sweep::Shard shard = sweep::ParseShard(arguments.shard);
  Scenario first = plan.base();  // becomes the scenario of the shard's first row
  plan.Configure(plan.ShardBegin(shard), 0, first);
  runner::CheckPossible(first, arguments.scenario);
  const std::filesystem::path out =
      arguments.out.empty() ? DefaultOut(arguments, plan, shard) : arguments.out;
  sweep::SweepFile file(out, plan, shard, arguments.force);
  const std::int64_t begin = file.next_unit();
  const std::int64_t end = plan.ShardEnd(shard);
  if (end == plan.ShardBegin(shard)) {
    Complain(fmt::format(
        "fogline sweep: warning: --shard {}: no rows, because the sweep can be divided into at "
        "most {}",
        arguments.shard, plan.units() == 1 ? "1 part" : fmt::format("{} parts", plan.units())));
  }
  if (begin > plan.ShardBegin(shard) && !arguments.json) {
    Notice(fmt::format("{}: {} of {} rows are there", PathText(out),
                       (begin - plan.ShardBegin(shard)) * plan.rows_per_unit(),
                       (end - plan.ShardBegin(shard)) * plan.rows_per_unit()));
  }
  WatchInterrupts();
  Progress progress("row", (end - begin) * plan.rows_per_unit());
  const TimePoint began = Clock::now();
  sweep::RunSweep(plan, begin, end, arguments.jobs,
                  [&](std::int64_t, const std::vector<sweep::SweepRow>& rows) {
                    file.Append(rows);
                    progress.Show((file.next_unit() - begin) * plan.rows_per_unit());
                    return !WasInterrupted();
                  });
  const std::int64_t rows = (file.next_unit() - begin) * plan.rows_per_unit();
  if (file.next_unit() != end) {
    throw Interrupted(fmt::format("interrupted after {}; call it again to go on", RowsText(rows)));
  }
  const double wall_s = std::chrono::duration<double>(Clock::now() - began).count();
  // The rate counts only the rows. It does not count the paired runs without traded control, which
  // the sweep also makes.
  const int cores = std::min(arguments.jobs, sweep::AllCores());
  const double rate = wall_s > 0 ? static_cast<double>(rows) / wall_s / cores : 0;
  if (arguments.json) {
    const nlohmann::ordered_json json{
        {"runs", rows}, {"wall_s", wall_s}, {"runs_per_s_per_core", rate}, {"out", out.string()}};
    cli::PrintJson(json);
  } else {
    PrintSummary(out, fmt::format("{} in {:.2f} s, {:.0f} rows per second and core", RowsText(rows),
                                  wall_s, rate));
  }
  return kDone;
}

}  // namespace

void AddSweep(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("sweep", "Run a grid of fields and seeds on all cores");
  const auto arguments = std::make_shared<SweepArguments>(*verb);
  verb->callback(
      [&action, arguments] { action = [arguments] { return RunSweepVerb(*arguments); }; });
}

}  // namespace fogline
