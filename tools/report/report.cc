#include "tools/report/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ranges>
#include <string_view>

#include <fmt/format.h>

#include "services/metrics/run_metrics.h"
#include "tools/report/assets.h"
#include "tools/report/curves.h"
#include "tools/report/figures.h"
#include "tools/report/html.h"
#include "tools/report/page_data.h"
#include "tools/report/story.h"
#include "tools/report/tables.h"

namespace fogline::report {
namespace {

std::string TitleOf(std::span<const ReportRun> runs, const std::optional<ReportCurves>& curves) {
  if (runs.empty()) return curves ? curves->scenario_title : "No runs";
  const std::string& title = runs.front().scenario_title;
  const bool same = std::all_of(runs.begin(), runs.end(),
                                [&](const ReportRun& run) { return run.scenario_title == title; });
  return same && !title.empty() ? title : fmt::format("{} runs", runs.size());
}

std::string Fact(std::string_view what, const std::string& value) {
  return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", what, value);
}

std::string MetricFact(std::string_view what, std::string_view name, double value,
                       std::string_view unit) {
  return Fact(what, fmt::format("{} {}", MetricElement(name, value, unit), unit));
}

std::string CollisionFact(const metrics::RunMetrics& measures) {
  if (!measures.collision_time_s) return "";
  const bool host = measures.collision == truth_t::COLLISION_HOST;
  return Fact("Collision",
              fmt::format("<strong>{}, at {} s</strong>", host ? "host" : "following car",
                          Decimal(*measures.collision_time_s, 1)));
}

/// Origin of a run: its log, scenario and seed.
std::string OriginElement(const ReportRun& run) {
  std::string parts;
  for (const std::string& part : {run.log, run.scenario_title}) {
    if (!part.empty()) parts += EscapeHtml(part) + " · ";
  }
  return fmt::format("<span class=\"origin\">{}seed {}</span>", parts, run.seed);
}

/// The part that an incomplete log lacks; "" for a complete log.
std::string ShortageElement(const ReportRun& run) {
  if (run.shortage.empty()) return "";
  return fmt::format("<span class=\"origin\">{}</span>", EscapeHtml(run.shortage));
}

/// A badge for an incomplete log; "" for a complete log.
std::string BadgeElement(const ReportRun& run) {
  if (run.shortage.empty()) return "";
  return fmt::format(" <span class=\"badge\" title=\"{}\">{}</span>", EscapeHtml(run.shortage),
                     BadgeOf(run));
}

/// One entry of the run selector: the origin of the run, and up to four values (safety improvement,
/// driving time of the human, worst compromised safety, collision).
std::string RunCard(std::span<const ReportRun> runs, std::size_t index) {
  const ReportRun& run = runs[index];
  std::string facts;
  if (run.si_pct) facts += MetricFact("Safety improvement", "si_pct", *run.si_pct, "%");
  const metrics::RunMetrics measures = metrics::Measure(run.samples, run.scenario);
  if (!run.has_gaps) {
    facts += MetricFact("Human drives", "human_time_s", measures.human_time_s, "s");
  }
  if (measures.max_compromised_safety_m) {
    facts += MetricFact("Worst compromised safety", "max_compromised_safety_m",
                        *measures.max_compromised_safety_m, "m");
  }
  facts += CollisionFact(measures);
  return fmt::format(
      "<label class=\"run {}\"><input type=\"checkbox\" value=\"{}\" checked>"
      "<span class=\"name\">{}{}</span>{}{}<dl>{}</dl></label>\n",
      RunStyle(index), index, EscapeHtml(RunName(runs, index)), BadgeElement(run),
      OriginElement(run), ShortageElement(run), facts);
}

std::string NumberedFigure(const Figure& figure, std::size_t number) {
  const std::string unit =
      figure.unit.empty() ? "" : fmt::format(" <span class=\"unit\">{}</span>", figure.unit);
  return FigureElement(figure.id,
                       fmt::format("<span class=\"number\">{}</span> {}", number, figure.title),
                       figure.caption, fmt::format("{}{}", figure.quantity, unit));
}

std::string ScenarioElement(std::span<const ReportRun> runs, std::size_t index) {
  const ReportRun& run = runs[index];
  return fmt::format(
      "<details><summary><i class=\"dot {}\"></i><span class=\"name\">{}</span>"
      "<span class=\"facts\">seed {}, digest <code>{}</code></span></summary>\n"
      "<pre tabindex=\"0\" aria-label=\"Scenario of {}\">{}</pre></details>\n",
      RunStyle(index), EscapeHtml(RunName(runs, index)), run.seed, EscapeHtml(run.digest),
      EscapeHtml(RunName(runs, index)), EscapeHtml(run.scenario_json));
}

std::string Section(std::string_view id, std::string_view title, const std::string& content) {
  if (content.empty()) return "";
  return fmt::format(
      "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}"
      "</h2>\n{2}</section>\n",
      id, title, content);
}

std::string TableSection(const std::optional<ReportTable>& table) {
  if (!table || table->rows.empty()) return "";
  std::string content = ThresholdTable(*table);
  if (!table->note.empty()) {
    content += fmt::format("<p class=\"note\">{}</p>\n", EscapeHtml(table->note));
  }
  return Section("table", "Safety and human engagement by threshold", content);
}

std::string CurvesSection(const std::optional<ReportCurves>& curves) {
  if (!curves || curves->points.empty()) return "";
  return Section("curves", "Every threshold, over seeds", CurvesContent(*curves));
}

/// A remark for each run in which some values are unknown.
std::string UnknownNotes(std::span<const ReportRun> runs, std::string ReportRun::*unknown) {
  std::string notes;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if ((runs[i].*unknown).empty()) continue;
    notes += fmt::format("<p class=\"note\">{}: unknown, because messages are missing: {}.</p>\n",
                         EscapeHtml(RunName(runs, i)), EscapeHtml(runs[i].*unknown));
  }
  return notes;
}

std::string RequestsSection(std::span<const ReportRun> runs) {
  std::string content = TakeOverTable(runs);
  if (!content.empty()) {
    content +=
        "<p class=\"note\">Times begin with the request. The other measures are of the interval "
        "from the request until the human has recovered, the automation drives again, or the car "
        "stands after a minimal risk manoeuvre.</p>\n";
  }
  content += UnknownNotes(runs, &ReportRun::unknown_take_overs);
  return Section("take-overs", "Take-overs", content);
}

/// The range of a number over all runs: "7", or "7 to 9" if the runs differ.
template <class Get>
std::string RangeOf(std::span<const ReportRun> runs, Get get) {
  const auto [first, last] = std::ranges::minmax(std::views::transform(runs, get));
  return first == last ? fmt::format("{}", first) : fmt::format("{} to {}", first, last);
}

/// Number of steps in the log of the run. A sample without values stands for a missing step.
std::int64_t StepsOf(const ReportRun& run) {
  return std::ranges::count_if(
      run.samples, [](const metrics::Sample& sample) { return !std::isnan(sample.host_gap_m); });
}

std::string SummaryOf(std::span<const ReportRun> runs, const std::optional<ReportCurves>& curves) {
  std::string summary;
  if (!runs.empty()) {
    summary =
        fmt::format("{} {} of {} steps, seed {}", runs.size(), runs.size() == 1 ? "run" : "runs",
                    RangeOf(runs, [](const ReportRun& run) { return StepsOf(run); }),
                    RangeOf(runs, [](const ReportRun& run) { return run.seed; }));
  }
  if (curves) {
    summary += fmt::format("{}{} thresholds over {}", runs.empty() ? "" : "; ",
                           curves->points.size(), SeedsText(*curves));
  }
  return summary;
}

/// Keeps a number and the word after it on one line.
std::string WithFixedNumbers(const std::string& text) {
  std::string fixed;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool after_digit = i > 0 && text[i - 1] >= '0' && text[i - 1] <= '9';
    fixed += text[i] == ' ' && after_digit ? "\u00a0" : std::string(1, text[i]);
  }
  return fixed;
}

std::string StoryElement(std::span<const ReportRun> runs) {
  const std::string story = WithFixedNumbers(StoryOf(runs));
  return story.empty() ? "" : fmt::format("<p class=\"story\">{}</p>\n", EscapeHtml(story));
}

}  // namespace

std::string MakeReport(std::span<const ReportRun> runs, const std::optional<ReportTable>& table,
                       const std::optional<ReportCurves>& curves) {
  std::string cards;
  std::string scenarios;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    cards += RunCard(runs, i);
    scenarios += ScenarioElement(runs, i);
  }
  std::string figures;
  for (std::size_t i = 0; i < Figures().size(); ++i) {
    figures += NumberedFigure(Figures()[i], i + 1);
  }
  const bool no_figures = runs.empty() && curves;
  const std::array scripts{assets::kModelJs,  assets::kScrollJs, assets::kChartJs,
                           assets::kLegendJs, assets::kCurvesJs, assets::kFrontJs,
                           assets::kPageJs};
  return Fill(
      assets::kPageHtml,
      {{"title", EscapeHtml(TitleOf(runs, curves))},
       {"style", fmt::format("{}\n{}", assets::kUplotCss, assets::kPageCss)},
       {"summary", SummaryOf(runs, curves)},
       {"story", StoryElement(runs)},
       {"runs", cards},
       {"table", TableSection(table)},
       {"curves", CurvesSection(curves)},
       {"figures_hidden", no_figures ? " hidden" : ""},
       {"figures", figures},
       {"measures", Section("measures", "Measures",
                            MetricTable(runs) + UnknownNotes(runs, &ReportRun::unknown_measures))},
       {"take_overs", RequestsSection(runs)},
       {"differences",
        Section("differences", "Differences between the scenarios", DifferenceTable(runs))},
       {"scenarios", Section("scenarios", "Scenarios", scenarios)},
       {"data", EscapeScript(PageData(runs, curves))},
       {"uplot", std::string(assets::kUplotJs)},
       {"uplot_license", EscapeHtml(assets::kUplotLicense)},
       {"uplot_version", std::string(assets::kUplotVersion)},
       {"script", fmt::format("{}", fmt::join(scripts, "\n"))}});
}

}  // namespace fogline::report
