// fogline table: prints safety improvement and redundant human engagement for each threshold.
#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/file_lock.h"
#include "common/interrupt.h"
#include "common/json.h"
#include "common/process/console.h"
#include "common/text.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/pairing.h"
#include "tools/cli/threshold_rows.h"
#include "tools/cli/transport_arguments.h"
#include "tools/fogline/verbs.h"
#include "tools/processes/external_roles.h"
#include "tools/sweep/engine.h"

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
    verb.add_option("--jobs", jobs,
                    "Runs at once (default: one; with --transport direct as many as there are "
                    "cores)")
        ->check(CLI::Range(1, 1024));
    verb.add_flag("--json", json, "Print as JSON");
    cli::ShowExitCodes(verb, {.check_failed = "--verify failed", .interruptible = true});
    verb.footer(
        "For each seed, makes one run without traded control and one for each threshold.\n"
        "Start the roles of --external again for each run, all with the same --lcm-url.\n\n"
        "Examples:\n"
        "  fogline table scenario/paper.json\n"
        "  fogline table scenario/paper.json --seeds 1:40\n"
        "  fogline table scenario/paper.json --transport udpm --logs logs/paper-table\n"
        "  fogline table scenario/paper.json --transport udpm --seeds 1:40 --jobs 4\n"
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
  std::optional<int> jobs;
  bool json = false;
};

/// @throws InputError
runner::RunOptions OptionsOf(const TableArguments& arguments) {
  runner::RunOptions options;
  options.samples = true;
  options.progress = false;  // there is one progress bar for all runs
  arguments.transport.Apply(options);
  const bool elsewhere = !options.external.empty() || !options.hosts.empty();
  if (elsewhere && arguments.jobs.value_or(1) > 1) {
    throw InputError(
        fmt::format("error: --jobs {}: roles that are started elsewhere take part in one run at a "
                    "time",
                    *arguments.jobs));
  }
  const bool own_port = options.transport == "udpm" || options.transport == "tcpq";
  if (!options.external.empty() && own_port) {
    throw InputError(
        fmt::format("error: --external needs --lcm-url: with {}, every run has a port of its own",
                    options.transport));
  }
  return options;
}

/// Tells the user to start the roles that the runs wait for.
void AskForRoles(const runner::RunOptions& options, std::int64_t runs) {
  const processes::ExternalRoles external(options.transport, options.traffic, options.wait);
  for (const Role role : options.external) {
    Notice(fmt::format("each of {} runs waits for the {} ({}); start it for each run with: {}",
                       runs, NameOf(role), external.Limit(), external.Command(role)));
  }
}

std::vector<double> ThresholdsOf(const TableArguments& arguments, const Scenario& scenario) {
  std::vector<double> thresholds;
  if (!arguments.thresholds.empty()) return sweep::ParseThresholds(arguments.thresholds);
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
    const auto put = [&out](const std::string& name, const std::string& unit,
                            const stats::Statistics& of) {
      out[name + unit] = OrNull(of.mean());
      out[name + "_std" + unit] = OrNull(of.deviation());
    };
    put("si_until_recovery", "_pct", row.si_until_recovery_pct);
    put("mean_compromised_safety_fog", "_m", row.cs_m);
    put("mean_compromised_safety_fog_without", "_m", row.cs_without_m);
    put("max_slow_down_fog_without", "_mps", row.slow_down_without_mps);
    for (std::size_t i = 0; i < metrics::kSafetyChoices.size(); ++i) {
      out["other_si_pct"][std::string(metrics::kSafetyChoices[i].name)] =
          OrNull(row.other_si_pct[i].Value());
    }
    json["rows"].push_back(std::move(out));
  }
  return json;
}

/// A value in the form "80.80"; "-" if there is no value.
std::string Cell(std::optional<double> value, int decimals = 2) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : std::string("-");
}

/// A mean in the form "80.80". For several seeds also the standard deviation: "80.81 +- 2.64".
std::string Spread(const stats::Statistics& of, int decimals = 2) {
  const auto deviation = of.deviation();
  return deviation ? fmt::format("{} +- {}", Cell(of.mean(), decimals), Cell(deviation, decimals))
                   : Cell(of.mean(), decimals);
}

/// The last columns of the table: SI until recovery, and the effect of the fog in metres and m/s.
std::string EffectHead(int width) {
  return fmt::format("  {:>{w}}  {:>{w}}  {:>{w}}  {:>{w}}", "SI recov. (%)", "CS (m)",
                     "CS none (m)", "slower (m/s)", fmt::arg("w", width));
}
std::string EffectCells(const sweep::ThresholdRow& row, int width) {
  constexpr int kDecimals = 4;  // a tenth of a millimetre
  constexpr int kSpeedDecimals = 3;
  return fmt::format("  {:>{w}}  {:>{w}}  {:>{w}}  {:>{w}}", Spread(row.si_until_recovery_pct),
                     Spread(row.cs_m, kDecimals), Spread(row.cs_without_m, kDecimals),
                     Spread(row.slow_down_without_mps, kSpeedDecimals), fmt::arg("w", width));
}

/// Says that SI depends on choices that the paper leaves open, and prints SI for other choices.
void PrintOtherChoices(const Scenario& scenario, const std::vector<sweep::ThresholdRow>& rows) {
  fmt::print(
      "\nCS: mean compromised safety in fog, with traded control and with none. slower: largest\n"
      "drop of the host's speed in fog, without traded control. SI recov.: SI from the beginning\n"
      "of the fog until the tracks have recovered.\n"
      "\nSI counts steps in fog with a compromised safety CS above a floor. The floor is a\n"
      "free parameter (/measures/safety_floor_m, {:g} m). The definition of CS is a free choice,\n"
      "too. SI (%) with other floors, and with two other definitions of CS: the decrease of the\n"
      "follower's gap, or of its safe distance d_r,f, since the fog began:\n\n  {:>6}",
      scenario.measures.safety_floor_m, "DoC_th");
  for (const metrics::SafetyChoice& choice : metrics::kSafetyChoices) {
    fmt::print("  {:>10}", choice.text);
  }
  for (const sweep::ThresholdRow& row : rows) {
    fmt::print("\n  {:>6g}", row.threshold);
    for (const metrics::Mean& si_pct : row.other_si_pct)
      fmt::print("  {:>10}", Cell(si_pct.Value()));
  }
  fmt::print("\n");
}

void PrintText(const Scenario& scenario, const sweep::SeedRange& seeds,
               const std::vector<sweep::ThresholdRow>& rows) {
  fmt::print("{}\n", EscapeControls(scenario.title));
  if (seeds.count() == 1) {
    fmt::print("seed {}\n\n", seeds.first);
  } else {
    fmt::print("seeds {} to {}: mean +- standard deviation\n\n", seeds.first, seeds.last);
  }
  const int width = seeds.count() == 1 ? 13 : 18;
  fmt::print("  {:>6}  {:>16}  {:>14}  {:>14}  {:>14}  {:>10}{}\n", "DoC_th", "SI (%)", "RHE (%)",
             "published SI", "published RHE", "collisions", EffectHead(width));
  for (const sweep::ThresholdRow& row : rows) {
    const PublishedRow* published = PublishedOf(scenario, row.threshold);
    fmt::print("  {:>6g}  {:>16}  {:>14}  {:>14}  {:>14}  {:>10}{}\n", row.threshold,
               Spread(row.si_pct), Spread(row.rhe_pct), published ? Cell(published->si_pct) : "-",
               published ? Cell(published->rhe_pct) : "-", row.collisions, EffectCells(row, width));
    if (row.si_pct.count() > 0 && row.si_pct.count() < seeds.count()) {
      fmt::print("          SI of {} seeds: the others have no compromised safety to improve\n",
                 row.si_pct.count());
    }
  }
  const auto has_si = [](const sweep::ThresholdRow& row) { return row.si_pct.count() > 0; };
  if (std::ranges::none_of(rows, has_si)) {
    fmt::print(
        "\nno SI: without traded control the following car never comes too close (no fog?)\n");
    return;
  }
  PrintOtherChoices(scenario, rows);
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
  const runner::RunOptions options = OptionsOf(arguments);
  const sweep::SeedRange seeds = arguments.seeds.empty()
                                     ? sweep::SeedRange{scenario.seed, scenario.seed}
                                     : cli::ReadSeeds(arguments.seeds);
  const std::vector<double> thresholds = ThresholdsOf(arguments, scenario);
  std::optional<OutputFolder> folder;
  std::optional<FileLock> lock;
  if (!arguments.logs.empty()) {
    folder.emplace(arguments.logs, "--logs");
    lock.emplace(arguments.logs, FileLock::Kind::kOwn, "--logs", "table");
  }
  WatchInterrupts();
  const bool direct = options.transport == "direct";
  const int jobs = arguments.jobs.value_or(direct ? sweep::AllCores() : 1);
  AskForRoles(options, seeds.count() * (std::ssize(thresholds) + 1));
  const std::vector<sweep::ThresholdRow> rows =
      direct && arguments.logs.empty()
          ? cli::RowsInMemory(scenario, thresholds, seeds, jobs)
          : cli::RowsByRuns({.options = options,
                             .logs = arguments.logs,
                             .name = arguments.scenario.file().stem().string(),
                             .jobs = jobs},
                            scenario, thresholds, seeds);
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
