// fogline metrics: prints the measures of runs, from their logs alone.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/json.h"
#include "common/process/console.h"
#include "common/text.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/pairing.h"
#include "tools/fogline/verbs.h"
#include "tools/report/metric_text.h"

namespace fogline {
namespace {

struct MetricsArguments {
  std::vector<std::filesystem::path> logs;
  bool json = false;
};

int RunMetrics(const MetricsArguments& arguments) {
  std::vector<runner::LoggedRun> runs;
  const bool readable = cli::ForEachReadable(arguments.logs, [&](const std::filesystem::path& log) {
    runs.push_back(runner::ReadLoggedRun(log));
  });
  const std::vector<cli::Pairing> pairs = cli::MeasurePairs(runs);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const runner::LoggedRun& run = runs[i];
    if (!run.note.empty()) Complain(fmt::format("{}: {}", PathText(run.result.log), run.note));
    if (arguments.json) {
      nlohmann::ordered_json row{{"log", run.result.log.string()}, {"title", run.scenario.title},
                                 {"seed", run.result.seed},        {"steps", run.result.steps},
                                 {"complete", run.complete},       {"digest", run.result.digest}};
      metrics::VisitPairedMetrics(
          pairs[i].measures,
          [&row](std::string_view name, const std::optional<double>& value, std::string_view,
                 std::string_view) { row[std::string(name)] = OrNull(value); });
      if (run.result.realtime) row["realtime"] = cli::RealtimeJson(*run.result.realtime);
      row["metrics"] = nlohmann::ordered_json::parse(cli::MetricsJson(run.result));
      rows.push_back(std::move(row));
      continue;
    }
    const std::string collision = report::CollisionText(run.result.measures);
    fmt::print("{}: {}, seed {}{}{}\n", PathText(run.result.log),
               EscapeControls(run.scenario.title), run.result.seed, collision.empty() ? "" : ": ",
               collision);
    if (run.result.realtime) fmt::print("{}", cli::RealtimeText(*run.result.realtime));
    metrics::VisitPairedMetrics(
        pairs[i].measures, [](std::string_view name, const std::optional<double>& value,
                              std::string_view unit, std::string_view) {
          if (value) {
            fmt::print("  {:<32}{:>12} {}\n", name, report::MetricText(name, *value, unit), unit);
          }
        });
    fmt::print("{}", cli::MetricsText(run.result));
  }
  if (arguments.json) cli::PrintJson(rows);
  if (!readable) return kBadInput;
  return std::ranges::all_of(runs, &runner::LoggedRun::complete) ? kDone : kCheckFailed;
}

}  // namespace

void AddMetrics(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("metrics", "Measure runs from their logs alone");
  const auto arguments = std::make_shared<MetricsArguments>();
  verb->add_option("LOG", arguments->logs, "Event logs")->required();
  verb->add_flag("--json", arguments->json, "Print as JSON");
  cli::ShowExitCodes(*verb, {.check_failed = "a log is not complete"});
  verb->footer(
      "The safety improvement SI appears for runs whose pair without traded control (policy\n"
      "none) is among the logs.\n\nExamples:\n  fogline metrics logs/paper-1.lcm\n"
      "  fogline metrics logs/paper-table/*.lcm --json");
  verb->callback([&action, arguments] { action = [arguments] { return RunMetrics(*arguments); }; });
}

}  // namespace fogline
