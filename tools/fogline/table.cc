// fogline table: safety improvement and redundant human engagement for each threshold.
#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/interrupt.h"
#include "common/json.h"
#include "common/process/console.h"
#include "common/process/progress.h"
#include "common/text.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/pairing.h"
#include "tools/cli/threshold_rows.h"
#include "tools/cli/transport_arguments.h"
#include "tools/fogline/verbs.h"
#include "tools/processes/external_roles.h"

namespace fogline {
namespace {

struct TableArguments {
  explicit TableArguments(CLI::App& verb) : scenario(verb), transport(verb, "direct") {
    verb.add_option("--thresholds", thresholds,
                    "DoC thresholds a,b,c or first:last:count (default: the published ones, or "
                    "0.2,0.5,0.8)");
    verb.add_option("--seeds", seeds,
                    "Seeds A:B, both included; prints mean and standard deviation")
        ->excludes("--seed");
    verb.add_option("--logs", logs, "Folder for a log of every run; existing logs are replaced");
    verb.add_flag("--json", json, "Print as JSON");
    cli::ShowExitCodes(verb, {.check_failed = "--verify failed", .interruptible = true});
    verb.footer(
        "One run without traded control and one for each threshold, in pairs of equal seeds.\n"
        "Start the roles of --external again for each run, all with the same --lcm-url.\n\n"
        "Examples:\n"
        "  fogline table scenario/paper.json\n"
        "  fogline table scenario/paper.json --seeds 1:40\n"
        "  fogline table scenario/paper.json --transport udpm --logs logs/paper-table\n"
        "  fogline table scenario/paper.json --thresholds 0.01:0.99:99 --seeds 1:200 --json\n"
        "  while my_driver --lcm-url \"$URL\"; do :; done &\n"
        "  fogline table scenario/paper.json --external driver --lcm-url \"$URL\"\n\n"
        "`fogline report --curves` draws the table as curves.");
  }

  cli::ScenarioArguments scenario;
  cli::TransportArguments transport;
  std::string thresholds;
  std::string seeds;
  std::filesystem::path logs;
  bool json = false;
};

/// @throws InputError
runner::ExperimentOptions OptionsOf(const TableArguments& arguments) {
  runner::ExperimentOptions options;
  options.samples = true;
  arguments.transport.Apply(options);
  const bool own_port = options.transport == "udpm" || options.transport == "tcpq";
  if (!options.external.empty() && own_port) {
    throw InputError(
        fmt::format("error: --external needs --lcm-url: with {}, every run has a port of its own",
                    options.transport));
  }
  return options;
}

runner::ExperimentResult RunOne(const TableArguments& arguments, runner::ExperimentOptions options,
                                const Scenario& scenario, const std::string& name) {
  if (!arguments.logs.empty()) {
    options.log = arguments.logs / fmt::format("{}-seed{}-threshold-{}.lcm",
                                               arguments.scenario.file().stem().string(),
                                               scenario.seed, name);
  }
  const log::LogOfRun log = options.log.empty() ? log::LogOfRun() : log::LogOfRun(options.log);
  runner::ExperimentResult result = runner::RunExperiment(scenario, options);
  if (result.verification && !result.verification->Holds()) {
    throw cli::CheckFailed(
        fmt::format("seed {}, {}: {}", scenario.seed, name, result.verification->Trouble()));
  }
  return result;
}

/// Runs every pair on a transport, with logs if requested.
std::vector<sweep::ThresholdRow> RowsByRuns(const TableArguments& arguments,
                                            const runner::ExperimentOptions& options,
                                            Scenario scenario, std::span<const double> thresholds,
                                            const sweep::SeedRange& seeds) {
  const processes::ExternalRoles external(options.transport, options.traffic, options.wait);
  for (const Role role : options.external) {
    Notice(fmt::format("each of {} runs waits for the {} ({}); start it for each run with: {}",
                       seeds.count() * (std::ssize(thresholds) + 1), NameOf(role), external.Limit(),
                       external.Command(role)));
  }
  std::vector<sweep::ThresholdRow> rows;
  for (const double threshold : thresholds) rows.emplace_back().threshold = threshold;
  Progress progress("seed", seeds.count());
  for (std::int64_t seed = seeds.first; seed <= seeds.last; ++seed) {
    scenario.seed = seed;
    const runner::ExperimentResult baseline =
        RunOne(arguments, options, cli::WithoutTradedControl(scenario), "none");
    for (sweep::ThresholdRow& row : rows) {
      scenario.arbitrator.threshold = row.threshold;
      const runner::ExperimentResult result =
          RunOne(arguments, options, scenario, fmt::format("{:g}", row.threshold));
      row.Add(metrics::MeasurePair(baseline.samples, result.samples, scenario), result.measures);
    }
    progress.Show(seed - seeds.first + 1);
  }
  return rows;
}

std::vector<double> ThresholdsOf(const TableArguments& arguments, const Scenario& scenario) {
  if (!arguments.thresholds.empty()) return sweep::ParseThresholds(arguments.thresholds);
  std::vector<double> thresholds;
  for (const PublishedRow& row : scenario.published) thresholds.push_back(row.threshold);
  if (thresholds.empty()) thresholds = {0.2, 0.5, 0.8};
  return thresholds;
}

const PublishedRow* PublishedOf(const Scenario& scenario, double threshold) {
  for (const PublishedRow& row : scenario.published) {
    if (row.threshold == threshold) return &row;
  }
  return nullptr;
}

nlohmann::ordered_json ToJson(const std::filesystem::path& file, const std::string& transport,
                              const Scenario& scenario, const sweep::SeedRange& seeds,
                              const std::vector<sweep::ThresholdRow>& rows) {
  nlohmann::ordered_json json{
      {"scenario", file.string()}, {"transport", transport},
      {"seeds", seeds.count()},    {"first_seed", seeds.first},
      {"last_seed", seeds.last},   {"rows", nlohmann::ordered_json::array()}};
  for (const sweep::ThresholdRow& row : rows) {
    const stats::Summary si = row.si_pct.Result();
    const stats::Summary rhe = row.rhe_pct.Result();
    nlohmann::ordered_json out{
        {"threshold", row.threshold},           {"si_pct", OrNull(si.mean)},
        {"rhe_pct", OrNull(rhe.mean)},          {"si_std_pct", OrNull(si.deviation)},
        {"rhe_std_pct", OrNull(rhe.deviation)}, {"si_ci95_pct", OrNull(si.ci95)},
        {"rhe_ci95_pct", OrNull(rhe.ci95)},     {"si_p5_pct", OrNull(si.p5)},
        {"si_p95_pct", OrNull(si.p95)},         {"si_seeds", si.count},
        {"collisions", row.collisions}};
    if (const PublishedRow* published = PublishedOf(scenario, row.threshold)) {
      out["published_si_pct"] = published->si_pct;
      out["published_rhe_pct"] = published->rhe_pct;
    }
    json["rows"].push_back(std::move(out));
  }
  return json;
}

void PrintText(const Scenario& scenario, const sweep::SeedRange& seeds,
               const std::vector<sweep::ThresholdRow>& rows) {
  const auto cell = [](std::optional<double> value) {
    return value ? fmt::format("{:.2f}", *value) : std::string("-");
  };
  const auto spread = [&](const stats::Summary& of) {
    return of.deviation ? fmt::format("{} +- {}", cell(of.mean), cell(of.deviation))
                        : cell(of.mean);
  };
  fmt::print("{}\n", EscapeControls(scenario.title));
  if (seeds.count() == 1) {
    fmt::print("seed {}\n\n", seeds.first);
  } else {
    fmt::print("seeds {} to {}: mean +- standard deviation\n\n", seeds.first, seeds.last);
  }
  fmt::print("  {:>6}  {:>16}  {:>14}  {:>14}  {:>14}  {:>10}\n", "DoC_th", "SI (%)", "RHE (%)",
             "published SI", "published RHE", "collisions");
  for (const sweep::ThresholdRow& row : rows) {
    const stats::Summary si = row.si_pct.Result();
    const PublishedRow* published = PublishedOf(scenario, row.threshold);
    fmt::print("  {:>6g}  {:>16}  {:>14}  {:>14}  {:>14}  {:>10}\n", row.threshold, spread(si),
               spread(row.rhe_pct.Result()), published ? cell(published->si_pct) : "-",
               published ? cell(published->rhe_pct) : "-", row.collisions);
    if (si.count > 0 && si.count < seeds.count()) {
      fmt::print("          SI of {} seeds: the others have no compromised safety to improve\n",
                 si.count);
    }
  }
  const auto has_si = [](const sweep::ThresholdRow& row) { return row.si_pct.Result().count > 0; };
  if (std::ranges::none_of(rows, has_si)) {
    fmt::print(
        "\nno SI: without traded control the following car never comes too close (no fog?)\n");
  }
}

Scenario ScenarioOf(const TableArguments& arguments) {
  arguments.scenario.RefuseOverrideOf("/arbitrator/threshold",
                                      "the thresholds are those of --thresholds");
  if (!arguments.seeds.empty()) {
    arguments.scenario.RefuseOverrideOf("/seed", "the seeds are those of --seeds");
  }
  Scenario scenario = arguments.scenario.Load();
  sweep::RequireThreshold(scenario, arguments.scenario.file());
  return scenario;
}

int RunTable(const TableArguments& arguments) {
  const Scenario scenario = ScenarioOf(arguments);
  const runner::ExperimentOptions options = OptionsOf(arguments);
  const sweep::SeedRange seeds = arguments.seeds.empty()
                                     ? sweep::SeedRange{scenario.seed, scenario.seed}
                                     : cli::ReadSeeds(arguments.seeds);
  const std::vector<double> thresholds = ThresholdsOf(arguments, scenario);
  std::optional<FileLock> folder;
  if (!arguments.logs.empty()) {
    RequireWritableFolder(arguments.logs, "--logs");
    folder.emplace(arguments.logs, FileLock::Kind::kOwn, "--logs", "table");
  }
  WatchInterrupts();
  const std::vector<sweep::ThresholdRow> rows =
      options.transport == "direct" && arguments.logs.empty()
          ? cli::RowsOnAllCores(scenario, thresholds, seeds)
          : RowsByRuns(arguments, options, scenario, thresholds, seeds);
  if (arguments.json) {
    cli::PrintJson(ToJson(arguments.scenario.file(), options.transport, scenario, seeds, rows));
  } else {
    PrintText(scenario, seeds, rows);
  }
  return kDone;
}

}  // namespace

void AddTable(CLI::App& app, cli::Action& action) {
  CLI::App* verb =
      app.add_subcommand("table", "Safety improvement and redundant engagement by threshold");
  const auto arguments = std::make_shared<TableArguments>(*verb);
  verb->callback([&action, arguments] { action = [arguments] { return RunTable(*arguments); }; });
}

}  // namespace fogline
