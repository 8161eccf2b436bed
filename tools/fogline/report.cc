// fogline report: writes the figures and measures of runs as one HTML file, and the figures as PNG,
// SVG or PDF files for papers.
#include "tools/report/report.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <deque>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/text.h"
#include "scenario/sections/decision.h"
#include "services/metrics/gaps/holes.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/logs/log_reading.h"
#include "tools/cli/pairing.h"
#include "tools/cli/threshold_rows.h"
#include "tools/fogline/verbs.h"
#include "tools/report/assets.h"

namespace fogline {
namespace {

// Beginning of every page that MakeReport() makes.
constexpr std::string_view kDocumentType = "<!DOCTYPE html>";

struct ReportArguments {
  explicit ReportArguments(CLI::App& verb) : reading(verb) {}

  cli::LogReading reading;
  std::vector<std::filesystem::path> logs;
  std::filesystem::path curves;
  std::vector<std::string> overrides;
  std::string thresholds = "0.01:0.99:99";
  std::string seeds = "1:200";
  std::filesystem::path output = "report.html";
  std::filesystem::path png;
  std::filesystem::path svg;
  std::filesystem::path pdf;
  bool json = false;
};

/// An option for a folder of figures.
struct FigureOption {
  const char* name;
  const char* help;
  report::FigureFormat format;
  std::filesystem::path ReportArguments::*folder;
};

constexpr std::array kFigureOptions{
    FigureOption{"--png", "Folder for the figures as PNG files (needs gnuplot)",
                 report::FigureFormat::kPng, &ReportArguments::png},
    FigureOption{"--svg", "The same as SVG files", report::FigureFormat::kSvg,
                 &ReportArguments::svg},
    FigureOption{"--pdf", "The same as PDF files, 8 inches wide", report::FigureFormat::kPdf,
                 &ReportArguments::pdf},
};

/// Refuses to replace a file that is not an HTML page. For example, a shell changes "-o *.lcm" into
/// names of logs, and no log may be replaced.
/// @throws InputError
void RefuseToReplaceOther(const std::filesystem::path& output) {
  if (!IsReplaceable(output)) return;
  std::ifstream file(output, std::ios::binary);
  if (!file.is_open() || file.peek() == std::ifstream::traits_type::eof()) return;
  std::string head(kDocumentType.size(), '\0');
  file.read(head.data(), std::ssize(head));
  const auto same = [](unsigned char a, unsigned char b) {
    return std::tolower(a) == std::tolower(b);
  };
  if (!std::ranges::equal(head, kDocumentType, same)) {
    throw InputError(fmt::format(
        "{}: error: --output: the file is no HTML page and is not replaced", PathText(output)));
  }
}

bool HaveOneSeed(std::span<const runner::LoggedRun> runs) {
  return std::ranges::all_of(runs, [&](const runner::LoggedRun& run) {
    return run.result.seed == runs.front().result.seed;
  });
}

std::string LogNameOf(const runner::LoggedRun& run) { return run.result.log.filename().string(); }

std::string NameOf(const ArbitratorSection& arbitrator) {
  if (arbitrator.policy == Policy::kNone) return "without traded control";
  std::string name;
  if (arbitrator.policy != Policy::kTraded) {
    const auto row = static_cast<std::size_t>(arbitrator.policy);
    name = fmt::format("{}, ", ChoiceNames<Policy>::kNames[row]);
  }
  return name + fmt::format("threshold {:g}", arbitrator.threshold);
}

/// Names of the runs: policy and threshold, then the seed if the seeds differ. If two names are
/// still equal, the name of the log follows, and then its folder.
std::vector<std::string> NamesOf(std::span<const runner::LoggedRun> runs) {
  const bool with_seed = !HaveOneSeed(runs);
  std::vector<std::string> names;
  for (const runner::LoggedRun& run : runs) {
    const ArbitratorSection& arbitrator = run.scenario.arbitrator;
    std::string name = NameOf(arbitrator);
    if (with_seed) name += fmt::format(", seed {}", run.result.seed);
    names.push_back(std::move(name));
  }
  const auto add_to_equal = [&](const auto& text_of) {
    const std::vector<std::string> before = names;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (std::ranges::count(before, before[i]) > 1) {
        names[i] += fmt::format(", {}", text_of(runs[i]));
      }
    }
  };
  add_to_equal(LogNameOf);
  add_to_equal([](const runner::LoggedRun& run) {
    const std::filesystem::path folder = run.result.log.parent_path();
    return folder.empty() ? "." : PathText(folder);
  });
  return names;
}

std::vector<report::ReportMetric> MetricsOf(const metrics::RunMetrics& measures,
                                            const metrics::Lack& lack) {
  std::vector<report::ReportMetric> out;
  metrics::VisitMetrics(
      measures, [&]<class V>(std::string_view name, const V& value, std::string_view unit,
                             std::string_view description) {
        double number = std::numeric_limits<double>::quiet_NaN();
        if constexpr (std::is_same_v<V, std::optional<double>>) {
          number = value.value_or(number);
        } else {
          number = static_cast<double>(value);
        }
        if (!metrics::IsKnown(name, value, lack)) number = std::numeric_limits<double>::quiet_NaN();
        out.push_back({std::string(name), number, std::string(unit), std::string(description)});
      });
  return out;
}

/// The table of SI and RHE, computed only from the logs. It has one row for each run with an SI. A
/// run has an SI if the logs contain its paired run without traded control, and safety is
/// compromised in this paired run. The result is nullopt if no run has an SI.
std::optional<report::ReportTable> TableOf(std::span<const runner::LoggedRun> runs,
                                           std::span<const cli::Pairing> pairs) {
  const bool one_seed = HaveOneSeed(runs);
  report::ReportTable table;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!pairs[i].measures.si_pct) continue;
    const Scenario& scenario = runs[i].scenario;
    const metrics::RunMetrics& measures = runs[i].result.measures;
    const bool has_rhe =
        measures.rhe_pct && metrics::IsKnown("rhe_pct", measures.rhe_pct, runs[i].result.lack);
    report::ReportTable::Row row{
        .threshold = scenario.arbitrator.threshold,
        .seed = one_seed ? std::nullopt : std::optional(scenario.seed),
        .si_pct = *pairs[i].measures.si_pct,
        .rhe_pct = has_rhe ? *measures.rhe_pct : std::numeric_limits<double>::quiet_NaN(),
        .effect = metrics::FogEffectOf(measures),
        .without = pairs[i].without};
    for (const PublishedRow& published : scenario.published) {
      if (published.threshold != row.threshold) continue;
      row.published_si_pct = published.si_pct;
      row.published_rhe_pct = published.rhe_pct;
    }
    table.rows.push_back(row);
  }
  if (table.rows.empty()) return std::nullopt;
  if (one_seed) table.note = fmt::format("seed {}", runs.front().scenario.seed);
  return table;
}

/// The runs of the logs. Runs without traded control come first, because the other runs are
/// compared with them.
std::vector<runner::LoggedRun> ReadRuns(std::span<const std::filesystem::path> logs,
                                        const log::ReadOptions& options) {
  std::vector<runner::LoggedRun> runs;
  for (const std::filesystem::path& log : logs) {
    runs.push_back(runner::ReadLoggedRun(log, options));
    cli::SayAboutLog(log, runs.back());
    cli::SayWhatIsUnknown(runs.back());
  }
  std::stable_partition(runs.begin(), runs.end(), [](const runner::LoggedRun& run) {
    return run.scenario.arbitrator.policy == Policy::kNone;
  });
  return runs;
}

/// The measures of a run, and the latency of a person's inputs.
std::vector<report::ReportMetric> MetricsOf(const runner::RunResult& result) {
  std::vector<report::ReportMetric> out = MetricsOf(result.measures, result.lack);
  if (!result.input_latency) return out;
  log::VisitLatency(
      *result.input_latency, [&out](std::string_view name, std::int64_t value,
                                    std::string_view unit, std::string_view description) {
        out.push_back({fmt::format("input_latency_{}", name), static_cast<double>(value),
                       std::string(unit), std::string(description)});
      });
  return out;
}

/// The content of a run on the report's page.
report::ReportRun PageOf(const runner::LoggedRun& run, const std::string& name,
                         const metrics::PairedMetrics& paired) {
  return {.name = name,
          .log = LogNameOf(run),
          .shortage = run.complete ? "" : run.note,
          .ended = run.ended,
          .scenario = run.scenario,
          .scenario_title = run.scenario.title,
          .scenario_json = run.scenario_text,
          .seed = run.result.seed,
          .digest = log::DigestText(run),
          .has_gaps = run.gaps.Any() || run.result.lack.channels.any(),
          .samples = metrics::WithHoles(run.result.samples, run.scenario.step_s),
          .measures = MetricsOf(run.result),
          .si_pct = paired.si_pct,
          .si_until_recovery_pct = paired.si_until_recovery_pct,
          .take_overs = run.result.take_overs,
          .unknown_measures = cli::UnknownMeasuresText(run.result),
          .unknown_take_overs = cli::UnknownTakeOvers(run)};
}

report::ReportCurves ComputeCurves(const ReportArguments& arguments) {
  cli::RefuseOverride(arguments.overrides, "/arbitrator/threshold",
                      "the thresholds are those of --thresholds");
  cli::RefuseOverride(arguments.overrides, "/seed", "the seeds are those of --seeds");
  const Scenario scenario = LoadScenario(arguments.curves, arguments.overrides);
  sweep::RequireThreshold(scenario, arguments.curves);
  runner::CheckPossible(scenario, arguments.curves);
  std::vector<double> thresholds = sweep::ParseThresholds(arguments.thresholds);
  std::sort(thresholds.begin(), thresholds.end());
  const sweep::SeedRange seeds = cli::ReadSeeds(arguments.seeds);
  report::ReportCurves curves{.scenario_title = scenario.title,
                              .first_seed = seeds.first,
                              .last_seed = seeds.last,
                              .points = {},
                              .published = scenario.published};
  for (const sweep::ThresholdRow& row : cli::RowsInMemory(scenario, thresholds, seeds)) {
    curves.points.push_back({row.threshold, row.si_pct.Result(), row.rhe_pct.Result()});
  }
  return curves;
}

nlohmann::ordered_json ToJson(const ReportArguments& arguments,
                              std::span<const runner::LoggedRun> runs) {
  nlohmann::ordered_json json{{"report", arguments.output.string()},
                              {"runs", nlohmann::ordered_json::array()}};
  for (const FigureOption& option : kFigureOptions) {
    const std::filesystem::path& folder = arguments.*option.folder;
    const std::string key = option.name + 2;  // without "--"
    json[key] = nullptr;
    if (!folder.empty()) json[key] = folder.string();
  }
  for (const runner::LoggedRun& run : runs) {
    json["runs"].push_back(
        {{"log", run.result.log.string()}, {"seed", run.result.seed}, {"complete", run.complete}});
  }
  return json;
}

/// Writes the page and the files of figures. If one of these files cannot be written, no old file
/// changes.
void WriteFiles(const ReportArguments& arguments, std::span<const report::ReportRun> pages,
                const std::optional<report::ReportTable>& table,
                const std::optional<report::ReportCurves>& curves) {
  AtomicFiles files;
  files.Add(arguments.output).Write(report::MakeReport(pages, table, curves));
  for (const FigureOption& option : kFigureOptions) {
    const std::filesystem::path& folder = arguments.*option.folder;
    if (folder.empty()) continue;
    report::DrawFigures(folder, option.format, pages, files);
    if (curves) report::DrawCurveFigures(folder, option.format, *curves, files);
  }
  files.Finish();
}

int RunReport(const ReportArguments& arguments) {
  if (arguments.logs.empty() && arguments.curves.empty()) {
    throw InputError("error: neither LOG nor --curves is given: nothing to report");
  }
  if (const std::string why(report::assets::WhyNoPages()); !why.empty()) {
    throw std::runtime_error(why);
  }
  cli::RefuseJsonBeside(arguments.output, "--output", arguments.json);
  RefuseToReplaceOther(arguments.output);
  RequireWritable(arguments.output, "--output");
  std::deque<OutputFolder> folders;
  for (const FigureOption& option : kFigureOptions) {
    const std::filesystem::path& folder = arguments.*option.folder;
    if (!folder.empty()) folders.emplace_back(folder, option.name);
  }
  if (!arguments.curves.empty()) WatchInterrupts();
  std::vector<runner::LoggedRun> runs = ReadRuns(arguments.logs, arguments.reading.Options());
  const std::vector<cli::Pairing> pairs = cli::MeasurePairs(runs);
  const std::optional<report::ReportTable> table = TableOf(runs, pairs);
  std::vector<report::ReportRun> pages;
  const std::vector<std::string> names = NamesOf(runs);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    pages.push_back(PageOf(runs[i], names[i], pairs[i].measures));
  }
  std::optional<report::ReportCurves> curves;
  if (!arguments.curves.empty()) curves = ComputeCurves(arguments);
  WatchInterrupts();  // after this call, an interrupt leaves no partial file
  WriteFiles(arguments, pages, table, curves);
  if (arguments.json) {
    cli::PrintJson(ToJson(arguments, runs));
  } else if (!IsStdout(arguments.output)) {
    fmt::print("{}\n", PathText(arguments.output));
  }
  return std::ranges::all_of(runs, &runner::LoggedRun::complete) ? kDone : kCheckFailed;
}

}  // namespace

void AddReport(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("report", "Figures and measures of logs as one HTML file");
  const auto arguments = std::make_shared<ReportArguments>(*verb);
  verb->add_option("LOG", arguments->logs, "Event logs");
  CLI::Option* curves =
      verb->add_option("--curves", arguments->curves,
                       "Scenario file: add SI and RHE against the threshold, over seeds");
  verb->add_option("--thresholds", arguments->thresholds,
                   "Thresholds of the curves: a,b,c or first:last:count")
      ->needs(curves)
      ->capture_default_str();
  verb->add_option("--seeds", arguments->seeds, "Seeds of the curves: A:B, both included")
      ->needs(curves)
      ->capture_default_str();
  verb->add_option("--set", arguments->overrides,
                   "Override a field of the curves' scenario (repeatable)")
      ->needs(curves)
      ->allow_extra_args(false);
  verb->add_option("-o,--output", arguments->output,
                   "HTML file to write, or /dev/stdout; an existing file is replaced only if it is "
                   "an HTML page")
      ->capture_default_str();
  for (const FigureOption& option : kFigureOptions) {
    verb->add_option(option.name, *arguments.*option.folder, option.help);
  }
  verb->add_flag("--json", arguments->json, "Print the name of the page, and its runs, as JSON");
  cli::ShowExitCodes(*verb, {.check_failed = "a log is not complete", .interruptible = true});
  verb->footer(
      "Prints the name of the page. The page needs no network. It shows an incomplete log as\n"
      "far as it goes, and marks it; the exit code is then 1. Measures that need every step are\n"
      "unknown if messages are missing. The table of SI and RHE appears if a log of the same\n"
      "run without traded control is also given. Curves are computed on all cores: means\n"
      "of the seeds with their 95 % confidence intervals, percentiles, and the Pareto front of\n"
      "SI and RHE.\n\n"
      "Examples:\n"
      "  fogline report logs/paper-1.lcm\n"
      "  fogline report logs/demo/*.lcm --output logs/demo/report.html --png figures\n"
      "  fogline report logs/demo/*.lcm --svg figures --pdf figures\n"
      "  fogline report logs/demo/*.lcm --curves scenario/paper.json\n"
      "  fogline report --curves scenario/paper.json --thresholds 0.3:0.6:61 --seeds 1:1000 \\\n"
      "    --set /fog/bias_m=0.3");
  verb->callback([&action, arguments] { action = [arguments] { return RunReport(*arguments); }; });
}

}  // namespace fogline
