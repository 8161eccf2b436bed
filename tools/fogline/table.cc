// fogline table: safety improvement against redundant human engagement, by threshold.
#include <memory>
#include <optional>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "tools/fogline/arguments.h"
#include "tools/fogline/interrupt.h"
#include "tools/fogline/pairing.h"
#include "tools/fogline/progress.h"
#include "tools/fogline/verbs.h"
#include "tools/sweep/engine.h"
#include "tools/sweep/statistics.h"

namespace fogline {
namespace {

struct Row {
  double threshold = 0;
  Statistics si_pct;  // of the seeds that have one: SI needs compromised safety in the paired run
  Statistics rhe_pct;
};

struct TableArguments {
  explicit TableArguments(CLI::App& verb) : scenario(verb) {
    verb.add_option("--thresholds", thresholds,
                    "DoC thresholds (default: the published ones, or 0.2,0.5,0.8)")
        ->delimiter(',')
        ->check(CLI::Range(0.0, 1.0));
    verb.add_option("--seeds", seeds, "Seeds A:B, both included: mean and standard deviation");
    verb.add_option("--transport", transport, "direct, memq, udpm or an LCM URL, as of `run`")
        ->capture_default_str();
    verb.add_option("--logs", logs, "Folder for a log of every run (replaced if they exist)");
    verb.add_flag("--json", json, "Print as JSON");
    verb.footer(
        "One run without traded control and one for each threshold, in pairs of equal seeds.\n\n"
        "Examples:\n  fogline table scenario/paper.json\n"
        "  fogline table scenario/paper.json --seeds 1:40\n"
        "  fogline table scenario/paper.json --transport udpm --logs logs/paper-table\n"
        "  fogline table scenario/paper.json --thresholds 0.3,0.4,0.5 --json");
  }

  ScenarioArguments scenario;
  std::vector<double> thresholds;
  std::string seeds;
  std::string transport = "direct";
  std::filesystem::path logs;
  bool json = false;
};

ExperimentResult RunOne(const TableArguments& arguments, const Scenario& scenario,
                        const std::string& name) {
  ExperimentOptions options;
  options.transport = arguments.transport;
  if (!arguments.logs.empty()) {
    options.log = arguments.logs / fmt::format("{}-seed{}-threshold-{}.lcm",
                                               arguments.scenario.file().stem().string(),
                                               scenario.seed, name);
  }
  return RunExperiment(scenario, options);
}

void AddTo(Row& row, const std::optional<double>& si_pct, const RunMeasures& measures) {
  if (measures.rhe_pct) row.rhe_pct.Add(*measures.rhe_pct);
  if (si_pct) row.si_pct.Add(*si_pct);
}

/// Runs every pair on a transport, with logs if wanted.
void FillByRuns(const TableArguments& arguments, Scenario scenario, const SeedRange& seeds,
                std::vector<Row>& rows) {
  if (!arguments.logs.empty()) std::filesystem::create_directories(arguments.logs);
  Progress progress("seed", seeds.count());
  for (std::int64_t seed = seeds.first; seed <= seeds.last; ++seed) {
    scenario.seed = seed;
    const ExperimentResult baseline = RunOne(arguments, WithoutTradedControl(scenario), "none");
    for (Row& row : rows) {
      scenario.arbitrator.threshold = row.threshold;
      const ExperimentResult result =
          RunOne(arguments, scenario, fmt::format("{:g}", row.threshold));
      AddTo(
          row,
          SafetyImprovementPct(baseline.samples, result.samples, scenario.measures.safety_floor_m),
          result.measures);
    }
    progress.Show(seed - seeds.first + 1);
  }
}

/// The same in this process, on all cores.
void FillBySweep(const Scenario& scenario, const SeedRange& seeds, std::vector<Row>& rows) {
  Axis axis{.pointer = "/arbitrator/threshold", .values = {}};
  for (const Row& row : rows) axis.values.push_back(fmt::format("{}", row.threshold));
  const SweepPlan plan(scenario, {axis}, seeds);
  Progress progress("seed", seeds.count());
  RunSweep(plan, 0, plan.units(), AllCores(),
           [&](std::int64_t unit, const std::vector<SweepRow>& results) {
             for (std::size_t i = 0; i < rows.size(); ++i) {
               AddTo(rows[i], results[i].si_pct, results[i].measures);
             }
             progress.Show(unit + 1);
             return !WasInterrupted();
           });
  if (WasInterrupted()) throw Interrupted("interrupted");
}

std::vector<Row> MakeRows(const TableArguments& arguments, const Scenario& scenario) {
  std::vector<double> thresholds = arguments.thresholds;
  if (thresholds.empty()) {
    for (const PublishedRow& row : scenario.published) thresholds.push_back(row.threshold);
  }
  if (thresholds.empty()) thresholds = {0.2, 0.5, 0.8};
  std::vector<Row> rows;
  for (const double threshold : thresholds) rows.push_back({.threshold = threshold});
  return rows;
}

nlohmann::ordered_json OrNull(std::optional<double> value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

const PublishedRow* PublishedOf(const Scenario& scenario, double threshold) {
  for (const PublishedRow& row : scenario.published) {
    if (row.threshold == threshold) return &row;
  }
  return nullptr;
}

std::string ToJson(const TableArguments& arguments, const Scenario& scenario, std::int64_t seeds,
                   const std::vector<Row>& rows) {
  nlohmann::ordered_json json{{"scenario", arguments.scenario.file().string()},
                              {"transport", arguments.transport},
                              {"seeds", seeds},
                              {"rows", nlohmann::ordered_json::array()}};
  for (const Row& row : rows) {
    nlohmann::ordered_json out{{"threshold", row.threshold},
                               {"si_pct", OrNull(row.si_pct.mean())},
                               {"rhe_pct", OrNull(row.rhe_pct.mean())},
                               {"si_std_pct", OrNull(row.si_pct.deviation())},
                               {"rhe_std_pct", OrNull(row.rhe_pct.deviation())},
                               {"si_seeds", row.si_pct.count()}};
    if (const PublishedRow* published = PublishedOf(scenario, row.threshold)) {
      out["published_si_pct"] = published->si_pct;
      out["published_rhe_pct"] = published->rhe_pct;
    }
    json["rows"].push_back(std::move(out));
  }
  return json.dump(2);
}

void PrintText(const Scenario& scenario, std::int64_t seeds, const std::vector<Row>& rows) {
  const auto cell = [](std::optional<double> value) {
    return value ? fmt::format("{:.2f}", *value) : std::string("-");
  };
  const auto spread = [&](const Statistics& of) {
    return of.deviation() ? fmt::format("{} +- {}", cell(of.mean()), cell(of.deviation()))
                          : cell(of.mean());
  };
  fmt::print("{}\n", scenario.title);
  fmt::print("{} seed{}; mean +- standard deviation where there are several\n\n", seeds,
             seeds == 1 ? "" : "s");
  fmt::print("  DoC_th        SI (%)        RHE (%)      published SI   published RHE\n");
  for (const Row& row : rows) {
    const PublishedRow* published = PublishedOf(scenario, row.threshold);
    fmt::print("  {:>6g}  {:>16}  {:>14}  {:>14}  {:>14}\n", row.threshold, spread(row.si_pct),
               spread(row.rhe_pct), published ? cell(published->si_pct) : "-",
               published ? cell(published->rhe_pct) : "-");
    if (row.si_pct.count() < seeds) {
      fmt::print("          SI of {} seeds: the others have no compromised safety to improve\n",
                 row.si_pct.count());
    }
  }
}

int RunTable(const TableArguments& arguments) {
  const Scenario scenario = arguments.scenario.Load();
  const SeedRange range = arguments.seeds.empty() ? SeedRange{scenario.seed, scenario.seed}
                                                  : ParseSeeds(arguments.seeds);
  const std::int64_t seeds = range.count();
  std::vector<Row> rows = MakeRows(arguments, scenario);
  WatchInterrupts();
  if (arguments.transport == "direct" && arguments.logs.empty()) {
    FillBySweep(scenario, range, rows);
  } else {
    FillByRuns(arguments, scenario, range, rows);
  }
  if (arguments.json) {
    PrintJson(ToJson(arguments, scenario, seeds, rows));
  } else {
    PrintText(scenario, seeds, rows);
  }
  return kDone;
}

}  // namespace

void AddTable(CLI::App& app, Action& action) {
  CLI::App* verb =
      app.add_subcommand("table", "Safety improvement and redundant engagement by threshold");
  const auto arguments = std::make_shared<TableArguments>(*verb);
  verb->callback([&action, arguments] { action = [arguments] { return RunTable(*arguments); }; });
}

}  // namespace fogline
