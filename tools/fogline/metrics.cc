// fogline metrics: prints the measures of runs, from their logs alone.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/json.h"
#include "common/process/console.h"
#include "common/text.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/logs/log_reading.h"
#include "tools/cli/measures/run_text.h"
#include "tools/cli/measures/take_over_text.h"
#include "tools/cli/pairing.h"
#include "tools/export/take_over_csv.h"
#include "tools/fogline/verbs.h"
#include "tools/report/metric_text.h"

namespace fogline {
namespace {

struct MetricsArguments {
  explicit MetricsArguments(CLI::App& verb) : reading(verb) {}

  cli::LogReading reading;
  std::vector<std::filesystem::path> logs;
  std::filesystem::path take_overs;
  bool json = false;
};

/// Refuses to replace a file that is not a table of take-overs. For example, a shell changes
/// "--take-overs *.lcm" into names of logs, and no log may be replaced.
/// @throws InputError
void RequireTakeOverTable(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!IsReplaceable(file) || !std::filesystem::exists(file, ignored) ||
      std::filesystem::is_empty(file, ignored) || exports::IsTakeOverCsv(file)) {
    return;
  }
  throw InputError(
      fmt::format("{}: error: --take-overs: the file is no table of take-overs and is not replaced",
                  PathText(file)));
}

void WriteTakeOvers(const std::vector<runner::LoggedRun>& runs, const std::filesystem::path& file) {
  std::vector<exports::TakeOverRun> rows;
  for (const runner::LoggedRun& run : runs) {
    rows.push_back({.log = run.result.log.string(),
                    .seed = run.result.seed,
                    .take_overs = run.result.take_overs,
                    .unknown = !cli::UnknownTakeOvers(run).empty(),
                    .input_latency = run.result.input_latency});
  }
  exports::WriteTakeOverCsv(rows, file);
}

int RunMetrics(const MetricsArguments& arguments) {
  const bool writes_csv = !arguments.take_overs.empty();
  if (writes_csv) {
    cli::RefuseJsonBeside(arguments.take_overs, "--take-overs", arguments.json);
    RequireTakeOverTable(arguments.take_overs);
    RequireWritable(arguments.take_overs, "--take-overs");
  }
  const log::ReadOptions options = arguments.reading.Options();
  std::vector<runner::LoggedRun> runs;
  const bool readable = cli::ForEachReadable(arguments.logs, [&](const std::filesystem::path& log) {
    runs.push_back(runner::ReadLoggedRun(log, options));
  });
  if (writes_csv && readable) WriteTakeOvers(runs, arguments.take_overs);
  const std::vector<cli::Pairing> pairs = cli::MeasurePairs(runs);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const runner::LoggedRun& run = runs[i];
    cli::SayAboutLog(run.result.log, run);
    cli::SayWhatIsUnknown(run, pairs[i].unknown ? "si_pct, si_until_recovery_pct" : "");
    if (arguments.json) {
      nlohmann::ordered_json row{
          {"log", run.result.log.string()}, {"title", run.scenario.title},
          {"seed", run.result.seed},        {"steps", run.result.steps},
          {"complete", run.complete},       {"digest", cli::DigestJson(run)}};
      if (run.gaps.Any()) row["gaps"] = cli::GapsJson(run.gaps);
      if (const auto unknown = cli::UnknownMeasures(run.result); !unknown.empty()) {
        row["unknown_measures"] = unknown;
      }
      if (const std::string unknown = cli::UnknownTakeOvers(run); !unknown.empty()) {
        row["unknown_take_overs"] = unknown;
      }
      metrics::VisitPairedMetrics(
          pairs[i].measures,
          [&row](std::string_view name, const std::optional<double>& value, std::string_view,
                 std::string_view) { row[std::string(name)] = OrNull(value); });
      if (run.result.realtime) row["realtime"] = cli::RealtimeJson(*run.result.realtime);
      row["metrics"] = nlohmann::ordered_json::parse(cli::MetricsJson(run.result));
      cli::AddTakeOvers(run.result, row);
      rows.push_back(std::move(row));
      continue;
    }
    const std::string collision = report::CollisionText(run.result.measures);
    std::string text = fmt::format("{}: {}, seed {}{}{}\n", PathText(run.result.log),
                                   EscapeControls(run.scenario.title), run.result.seed,
                                   collision.empty() ? "" : ": ", collision);
    if (run.result.realtime) text += cli::RealtimeText(*run.result.realtime);
    metrics::VisitPairedMetrics(pairs[i].measures,
                                [&text](std::string_view name, const std::optional<double>& value,
                                        std::string_view unit, std::string_view) {
                                  if (!value) return;
                                  text += fmt::format("  {:<32}{:>12} {}\n", name,
                                                      report::MetricText(name, *value, unit), unit);
                                });
    text += cli::MetricsText(run.result) + cli::TakeOversText(run.result);
    cli::PrintBeside(arguments.take_overs, text);
  }
  if (arguments.json) cli::PrintJson(rows);
  if (!readable) return kBadInput;
  return std::ranges::all_of(runs, &runner::LoggedRun::complete) ? kDone : kCheckFailed;
}

}  // namespace

void AddMetrics(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("metrics", "Measure runs from their logs alone");
  const auto arguments = std::make_shared<MetricsArguments>(*verb);
  verb->add_option("LOG", arguments->logs, "Event logs")->required();
  verb->add_option("--take-overs", arguments->take_overs,
                   "CSV file to write: a line for each request to take over; if messages are "
                   "missing, also a line with the outcome unknown; an existing file is replaced "
                   "only if it is such a table");
  verb->add_flag("--json", arguments->json, "Print as JSON");
  cli::ShowExitCodes(*verb, {.check_failed = "a log is not complete"});
  verb->footer(
      "The safety improvement SI appears if a log of the same run without traded control\n"
      "(policy none) is also given. The measures of a request to take over (take_overs in JSON)\n"
      "appear for runs with such requests, the latency of inputs for runs in which a person\n"
      "drove. services/metrics/README.md defines them. If a log lacks messages, the measures are\n"
      "those of the steps that are there; measures that need every step are then unknown "
      "(null).\n\n"
      "Examples:\n  fogline metrics logs/paper-1.lcm\n"
      "  fogline metrics logs/paper-table/*.lcm --json\n"
      "  fogline metrics logs/drive-*.lcm --take-overs take-overs.csv");
  verb->callback([&action, arguments] { action = [arguments] { return RunMetrics(*arguments); }; });
}

}  // namespace fogline
