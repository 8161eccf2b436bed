#include "tools/report/tables.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <boost/algorithm/string/replace.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "services/metrics/safety_improvement.h"
#include "tools/report/figures.h"
#include "tools/report/html.h"
#include "tools/report/metric_text.h"
#include "tools/stats/statistics.h"

namespace fogline::report {
namespace {

constexpr int kPercentDecimals = 2;  // as in the paper

/// A table in a container that scrolls sideways, so that the page never scrolls sideways.
std::string Scrolling(std::string_view label, std::string_view head, std::string_view body) {
  return fmt::format(
      "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{}\">\n<table>\n"
      "<thead>\n{}</thead>\n<tbody>\n{}</tbody>\n</table>\n</div>\n",
      label, head, body);
}

std::string HeadOfRuns(std::string_view first, std::span<const ReportRun> runs) {
  std::string head = fmt::format("<tr><th scope=\"col\">{}</th>", first);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    head += fmt::format("<th scope=\"col\"><i class=\"dot {}\"></i>{}</th>", RunStyle(i),
                        EscapeHtml(RunName(runs, i)));
  }
  return head + "</tr>\n";
}

std::string PercentCell(double value) {
  return fmt::format("<td>{}</td>", DataElement(value, kPercentDecimals));
}

std::string EffectCell(const std::optional<double>& value) {
  constexpr int kDecimals = 4;  // a tenth of a millimetre, or of a millimetre per second
  return fmt::format("<td>{}</td>", DataElement(value.value_or(stats::kMissing), kDecimals));
}

/// Cells for the value of our runs, and for its standard deviation if there is one.
std::string OwnCells(double value, const std::optional<double>& deviation) {
  const std::string spread =
      deviation ? fmt::format("± {}", DataElement(*deviation, kPercentDecimals)) : "";
  return fmt::format("<td class=\"own\">{}</td><td class=\"deviation\">{}</td>",
                     DataElement(value, kPercentDecimals), spread);
}

bool HasSeeds(const ReportTable& table) {
  return std::ranges::any_of(table.rows, [](const auto& row) { return row.seed.has_value(); });
}

std::string RowOf(const ReportTable::Row& row, bool with_seed) {
  std::string seed;
  if (with_seed) seed = fmt::format("<td>{}</td>", row.seed ? std::to_string(*row.seed) : "–");
  return fmt::format(
      "<tr><th scope=\"row\"><data value=\"{0}\">{0}</data></th>{1}{2}{3}{4}{5}{6}{7}{8}</tr>\n",
      row.threshold, seed, OwnCells(row.si_pct, row.si_std_pct),
      PercentCell(row.published_si_pct.value_or(stats::kMissing)),
      OwnCells(row.rhe_pct, row.rhe_std_pct),
      PercentCell(row.published_rhe_pct.value_or(stats::kMissing)),
      EffectCell(row.effect.mean_compromised_safety_m),
      EffectCell(row.without.mean_compromised_safety_m), EffectCell(row.without.slow_down_mps));
}

/// Cells for mean, standard deviation, half of the 95 % confidence interval, 5th and 95th
/// percentile.
std::string SummaryCells(const stats::Summary& summary) {
  std::string cells;
  for (const std::optional<double>& value :
       {summary.mean, summary.deviation, summary.ci95, summary.p5, summary.p95}) {
    cells += PercentCell(value.value_or(stats::kMissing));
  }
  return cells;
}

/// A row of the table of measures; runs may have different measures.
struct MetricRow {
  ReportMetric measure;
  std::vector<std::optional<double>> values;  // of each run; nullopt if the run lacks the measure
};

void Put(std::vector<MetricRow>& rows, const ReportMetric& measure, std::size_t run,
         std::size_t num_runs) {
  const auto same = [&](const MetricRow& row) {
    return row.measure.name == measure.name && row.measure.unit == measure.unit && !row.values[run];
  };
  auto found = std::find_if(rows.begin(), rows.end(), same);
  if (found == rows.end()) {
    rows.push_back({measure, std::vector<std::optional<double>>(num_runs)});
    found = rows.end() - 1;
  }
  found->values[run] = measure.value;
}

std::vector<MetricRow> MetricRows(std::span<const ReportRun> runs) {
  std::vector<MetricRow> rows;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    metrics::VisitPairedMetrics(
        {.si_pct = runs[i].si_pct, .si_until_recovery_pct = runs[i].si_until_recovery_pct},
        [&](std::string_view name, const std::optional<double>& value, std::string_view unit,
            std::string_view description) {
          if (!value) return;
          Put(rows, {std::string(name), *value, std::string(unit), std::string(description)}, i,
              runs.size());
        });
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (const ReportMetric& measure : runs[i].measures) Put(rows, measure, i, runs.size());
  }
  return rows;
}

/// A unit with exponents, such as "m/s²" for "m/s2".
std::string UnitText(std::string unit) {
  boost::replace_all(unit, "2", "²");
  boost::replace_all(unit, "3", "³");
  return EscapeHtml(unit);
}

/// Description of a measure, its unit, and its name in JSON and CSV.
std::string HeadOf(const ReportMetric& measure) {
  const bool described = !measure.description.empty();
  std::string head = EscapeHtml(described ? measure.description : measure.name);
  if (!measure.unit.empty()) {
    head += fmt::format("\u00a0<span class=\"unit\">{}</span>", UnitText(measure.unit));
  }
  if (described) head += fmt::format("<small>{}</small>", EscapeHtml(measure.name));
  return head;
}

/// The values of a request to take over.
std::vector<ReportMetric> MeasuresOf(const metrics::TakeOverMeasures& request) {
  std::vector<ReportMetric> measures;
  metrics::VisitTakeOver(request, [&](std::string_view name, const std::optional<double>& value,
                                      std::string_view unit, std::string_view description) {
    measures.push_back({std::string(name), value.value_or(stats::kMissing), std::string(unit),
                        std::string(description)});
  });
  return measures;
}

/// A row with a cell for each request; "" if no request has a value of this measure.
std::string RowOf(std::span<const std::vector<ReportMetric>> requests, std::size_t measure) {
  std::string row = fmt::format("<tr><th scope=\"row\">{}</th>", HeadOf(requests[0][measure]));
  bool has_value = false;
  for (const std::vector<ReportMetric>& request : requests) {
    const ReportMetric& cell = request[measure];
    has_value = has_value || !std::isnan(cell.value);
    row += fmt::format("<td>{}</td>", MetricElement(cell.name, cell.value, cell.unit));
  }
  return has_value ? row + "</tr>\n" : "";
}

/// The scenario's fields by JSON pointer; empty if the text is not JSON.
nlohmann::json FieldsOf(const ReportRun& run) {
  const auto scenario =
      nlohmann::json::parse(run.scenario_json, nullptr, /*allow_exceptions=*/false);
  if (!scenario.is_object()) return nlohmann::json::object();
  return scenario.flatten();
}

std::string TextOf(const nlohmann::json& fields, const std::string& pointer) {
  constexpr auto kReplaceBadUtf8 = nlohmann::json::error_handler_t::replace;
  const auto found = fields.find(pointer);
  if (found == fields.end()) return "–";
  return EscapeHtml(found->is_string() ? found->get<std::string>()
                                       : found->dump(-1, ' ', false, kReplaceBadUtf8));
}

}  // namespace

std::string RunName(std::span<const ReportRun> runs, std::size_t index) {
  return runs[index].name.empty() ? fmt::format("run {}", index + 1) : runs[index].name;
}

std::string BadgeOf(const ReportRun& run) {
  if (run.shortage.empty()) return "";
  if (run.samples.empty()) return fmt::format("incomplete: has no step of {}", run.scenario.steps);
  if (run.ended || run.samples.back().last) return "incomplete log";
  return fmt::format("incomplete: ends after step {} of {}", run.samples.back().step,
                     run.scenario.steps);
}

std::string ThresholdTable(const ReportTable& table) {
  const bool with_seed = HasSeeds(table);
  std::string rows;
  for (const ReportTable::Row& row : table.rows) rows += RowOf(row, with_seed);
  return Scrolling(
      "Safety improvement and redundant human engagement by threshold",
      fmt::format("<tr><th scope=\"col\" rowspan=\"2\">DoC threshold</th>{}"
                  "<th scope=\"colgroup\" colspan=\"3\">Safety improvement (%)</th>"
                  "<th scope=\"colgroup\" colspan=\"3\">Redundant human engagement (%)</th>"
                  "<th scope=\"colgroup\" colspan=\"2\">Mean compromised safety in fog (m)</th>"
                  "<th scope=\"col\">Slow-down in fog (m/s)</th></tr>\n"
                  "<tr><th scope=\"col\" colspan=\"2\">Fogline</th><th scope=\"col\">published</th>"
                  "<th scope=\"col\" colspan=\"2\">Fogline</th><th scope=\"col\">published</th>"
                  "<th scope=\"col\">Fogline</th><th scope=\"col\">without traded control</th>"
                  "<th scope=\"col\">without traded control</th></tr>\n",
                  with_seed ? "<th scope=\"col\" rowspan=\"2\">Seed</th>" : ""),
      rows);
}

std::string CurveTable(const ReportCurves& curves, std::span<const FrontPoint> points) {
  std::vector<bool> on_front(curves.points.size());
  for (const FrontPoint& point : points) {
    for (const std::size_t row : point.rows) on_front[row] = point.on_front;
  }
  std::string rows;
  for (std::size_t i = 0; i < curves.points.size(); ++i) {
    const ReportCurves::Point& point = curves.points[i];
    rows += fmt::format(
        "<tr><th scope=\"row\"><data value=\"{0}\">{0:g}</data></th>{1}{2}<td>{3}</td></tr>\n",
        point.threshold, SummaryCells(point.si_pct), SummaryCells(point.rhe_pct),
        on_front[i] ? "yes" : "");
  }
  constexpr std::string_view kMeasure =
      "<th scope=\"col\">mean</th><th scope=\"col\">std. dev.</th><th scope=\"col\">95 % CI ±</th>"
      "<th scope=\"col\">5th pct.</th><th scope=\"col\">95th pct.</th>";
  return Scrolling(
      "Safety improvement and redundant human engagement at every threshold",
      fmt::format("<tr><th scope=\"col\" rowspan=\"2\">DoC threshold</th>"
                  "<th scope=\"colgroup\" colspan=\"5\">Safety improvement (%)</th>"
                  "<th scope=\"colgroup\" colspan=\"5\">Redundant human engagement (%)</th>"
                  "<th scope=\"col\" rowspan=\"2\">on the front</th></tr>\n<tr>{0}{0}</tr>\n",
                  kMeasure),
      rows);
}

std::string MetricTable(std::span<const ReportRun> runs) {
  std::string body;
  for (const MetricRow& row : MetricRows(runs)) {
    body += fmt::format("<tr><th scope=\"row\">{}</th>", HeadOf(row.measure));
    for (const std::optional<double>& value : row.values) {
      body += fmt::format(
          "<td>{}</td>",
          MetricElement(row.measure.name, value.value_or(stats::kMissing), row.measure.unit));
    }
    body += "</tr>\n";
  }
  return Scrolling("Measures of the runs", HeadOfRuns("Measure", runs), body);
}

std::string TakeOverTable(std::span<const ReportRun> runs) {
  std::string head = "<tr><th scope=\"col\">Measure</th>";
  std::string body = "<tr><th scope=\"row\">outcome</th>";
  std::vector<std::vector<ReportMetric>> requests;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (std::size_t k = 0; k < runs[i].take_overs.size(); ++k) {
      const metrics::TakeOverMeasures& request = runs[i].take_overs[k];
      head += fmt::format("<th scope=\"col\"><i class=\"dot {}\"></i>{}, request {}</th>",
                          RunStyle(i), EscapeHtml(RunName(runs, i)), k + 1);
      body += fmt::format("<td>{}</td>", OutcomeText(request.outcome));
      requests.push_back(MeasuresOf(request));
    }
  }
  if (requests.empty()) return "";
  body += "</tr>\n";
  for (std::size_t i = 0; i < requests.front().size(); ++i) body += RowOf(requests, i);
  return Scrolling("Requests to take over", head + "</tr>\n", body);
}

std::string DifferenceTable(std::span<const ReportRun> runs) {
  constexpr std::size_t kMostRows = 50;  // recorded speeds may differ in thousands of fields
  std::vector<nlohmann::json> fields;
  nlohmann::json pointers = nlohmann::json::object();  // ordered by key
  for (const ReportRun& run : runs) {
    fields.push_back(FieldsOf(run));
    pointers.update(fields.back());
  }
  std::string body;
  std::size_t rows = 0;
  for (const auto& [pointer, unused] : pointers.items()) {
    if (pointer == "/title" || pointer == "/description") continue;
    std::vector<std::string> texts;
    for (const nlohmann::json& of_run : fields) texts.push_back(TextOf(of_run, pointer));
    if (std::equal(texts.begin() + 1, texts.end(), texts.begin())) continue;
    if (++rows > kMostRows) continue;
    body += fmt::format("<tr><th scope=\"row\"><code>{}</code></th>", EscapeHtml(pointer));
    for (const std::string& text : texts) body += fmt::format("<td>{}</td>", text);
    body += "</tr>\n";
  }
  if (rows == 0) return "";
  std::string table = Scrolling("Scenario fields that differ", HeadOfRuns("Field", runs), body);
  if (rows > kMostRows) {
    table += fmt::format("<p class=\"note\">and {} more</p>\n", rows - kMostRows);
  }
  return table;
}

}  // namespace fogline::report
