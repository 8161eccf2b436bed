// fogline report: the figures and measures of runs as one HTML file, and as PNG files for papers.
#include "tools/report/report.h"

#include <fstream>
#include <limits>
#include <memory>

#include <fmt/core.h>

#include "tools/fogline/arguments.h"
#include "tools/fogline/pairing.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

struct ReportArguments {
  std::vector<std::filesystem::path> logs;
  std::filesystem::path output = "report.html";
  std::filesystem::path png;
};

std::string NameOf(const LoggedRun& run) {
  const ArbitratorSection& arbitrator = run.scenario.arbitrator;
  if (arbitrator.policy == Policy::kAutomation) return "without traded control";
  return fmt::format("threshold {:g}", arbitrator.threshold);
}

std::vector<ReportMeasure> MeasuresOf(const RunMeasures& measures) {
  std::vector<ReportMeasure> out;
  VisitMeasures(measures, [&out]<class V>(std::string_view name, const V& value,
                                          std::string_view unit, std::string_view description) {
    double number = std::numeric_limits<double>::quiet_NaN();
    if constexpr (std::is_same_v<V, std::optional<double>>) {
      number = value.value_or(number);
    } else {
      number = static_cast<double>(value);
    }
    out.push_back({std::string(name), number, std::string(unit), std::string(description)});
  });
  return out;
}

/// The table that the logs give by themselves: one row for each run with a pair. Nothing without
/// one.
std::optional<ReportTable> TableOf(std::span<const LoggedRun> runs,
                                   std::span<const std::optional<double>> improvements) {
  ReportTable table;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!improvements[i]) continue;
    const Scenario& scenario = runs[i].scenario;
    ReportTable::Row row{.threshold = scenario.arbitrator.threshold,
                         .si_pct = *improvements[i],
                         .rhe_pct = runs[i].result.measures.rhe_pct.value_or(
                             std::numeric_limits<double>::quiet_NaN())};
    for (const PublishedRow& published : scenario.published) {
      if (published.threshold != row.threshold) continue;
      row.published_si_pct = published.si_pct;
      row.published_rhe_pct = published.rhe_pct;
    }
    table.rows.push_back(row);
  }
  if (table.rows.empty()) return std::nullopt;
  table.note = fmt::format("seed {}", runs.front().scenario.seed);
  return table;
}

int RunReport(const ReportArguments& arguments) {
  std::vector<LoggedRun> runs;
  for (const std::filesystem::path& log : arguments.logs) {
    runs.push_back(ReadLoggedRun(log));
    if (!runs.back().note.empty()) {
      fmt::print(stderr, "{}: {}\n", log.string(), runs.back().note);
    }
  }
  const std::vector<std::optional<double>> improvements = SafetyImprovements(runs);
  const std::optional<ReportTable> table = TableOf(runs, improvements);
  std::vector<ReportRun> pages;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    LoggedRun& run = runs[i];
    pages.push_back({.name = NameOf(run),
                     .scenario_title = run.scenario.title,
                     .scenario_json = run.scenario_text,
                     .seed = run.result.seed,
                     .digest = run.result.digest,
                     .samples = std::move(run.result.samples),
                     .measures = MeasuresOf(run.result.measures),
                     .si_pct = improvements[i]});
  }
  std::ofstream file(arguments.output, std::ios::binary);
  file << MakeReport(pages, table);
  if (!file.flush()) {
    throw InputError(fmt::format("{}: error: --output: cannot write", arguments.output.string()));
  }
  if (!arguments.png.empty()) WritePngFigures(arguments.png, pages);
  return kDone;
}

}  // namespace

void AddReport(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand("report", "Figures and measures of logs as one HTML file");
  const auto arguments = std::make_shared<ReportArguments>();
  verb->add_option("LOG", arguments->logs, "Event logs")->required();
  verb->add_option("-o,--output", arguments->output, "HTML file to write")->capture_default_str();
  verb->add_option("--png", arguments->png, "Folder for the figures as PNG files (needs gnuplot)");
  verb->footer(
      "The page needs no network. The table appears for runs whose pair without traded\n"
      "control is among the logs.\n\nExamples:\n  fogline report logs/paper-1.lcm\n"
      "  fogline report logs/demo/*.lcm --output logs/demo/report.html --png figures");
  verb->callback([&action, arguments] { action = [arguments] { return RunReport(*arguments); }; });
}

}  // namespace fogline
