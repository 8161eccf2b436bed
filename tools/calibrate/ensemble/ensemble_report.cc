#include "tools/calibrate/ensemble/ensemble_report.h"

#include <cmath>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/text.h"
#include "tools/calibrate/fit.h"
#include "tools/calibrate/scenario_text.h"
#include "tools/stats/statistics.h"

namespace fogline::calibrate {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string SeedsText(const Objective& objective) {
  const sweep::SeedRange& seeds = objective.problem().seeds;
  return fmt::format("{}:{}", seeds.first, seeds.last);
}

/// The text of a number of points, such as "1 point" or "0.5 points".
std::string PointsText(double points) {
  return fmt::format("{:g} point{}", points, points == 1 ? "" : "s");
}

/// One line of the table: a quantity, and its value in each set.
struct QuantityLine {
  std::string name;
  std::string_view unit;
  std::string lowest;  // bounds of a free field
  std::string highest;
  // For a free field: its scale, "linear" or "log". For a field that follows from the free fields:
  // "derived". For SI, RHE and the distance from the target: the seeds, such as "1:100".
  std::string kind;
  std::vector<double> values;
};

void AddFields(const EnsembleReport& report, std::vector<QuantityLine>& lines) {
  const CalibrationProblem& problem = report.searched.problem();
  for (std::size_t i = 0; i < problem.fields.size(); ++i) {
    const FreeField& field = problem.fields[i];
    QuantityLine& line =
        lines.emplace_back(QuantityLine{.name = field.pointer(),
                                        .unit = field.unit(),
                                        .lowest = NumberText(field.lowest()),
                                        .highest = NumberText(field.highest()),
                                        .kind = field.is_logarithmic() ? "log" : "linear",
                                        .values = {}});
    for (const ParameterSet& set : report.found.sets) line.values.push_back(set.values[i]);
  }
  const std::size_t first = lines.size();
  for (const ParameterSet& set : report.found.sets) {
    const std::vector<FieldValue> changes = report.searched.Changes(set.values);
    for (std::size_t i = problem.fields.size(); i < changes.size(); ++i) {
      const std::size_t place = first + i - problem.fields.size();
      if (place == lines.size()) {
        lines.push_back({changes[i].pointer, "m", "", "", "derived", {}});
      }
      lines[place].values.push_back(changes[i].value);
    }
  }
}

/// Adds the lines for the numbers of the tables (SI, RHE) over the seeds of one objective.
void AddTables(const EnsembleReport& report, const Objective& objective,
               Evaluation ParameterSet::*tables, std::vector<QuantityLine>& lines) {
  const auto add = [&](std::string name, std::string_view unit, const auto& value_of) {
    QuantityLine& line =
        lines.emplace_back(QuantityLine{std::move(name), unit, "", "", SeedsText(objective), {}});
    for (const ParameterSet& set : report.found.sets) line.values.push_back(value_of(set.*tables));
  };
  const std::vector<TargetRow>& target = objective.problem().target;
  for (std::size_t row = 0; row < target.size(); ++row) {
    const double threshold = target[row].threshold;
    add(fmt::format("mean SI at {:g}", threshold), "%", [row](const Evaluation& table) {
      return table.rows[row].si_pct.mean().value_or(stats::kMissing);
    });
    add(fmt::format("std of SI at {:g}", threshold), "%", [row](const Evaluation& table) {
      return table.rows[row].si_pct.deviation().value_or(stats::kMissing);
    });
    add(fmt::format("mean RHE at {:g}", threshold), "%", [row](const Evaluation& table) {
      return table.rows[row].rhe_pct.mean().value_or(stats::kMissing);
    });
  }
  add("distance from the target", "points", TableDistance);
}

std::vector<QuantityLine> LinesOf(const EnsembleReport& report) {
  std::vector<QuantityLine> lines;
  AddFields(report, lines);
  AddTables(report, report.searched, &ParameterSet::searched, lines);
  AddTables(report, report.fresh, &ParameterSet::fresh, lines);
  return lines;
}

std::string NumberOrNothing(double value, int digits) {
  return std::isnan(value) ? "" : fmt::format("{:.{}g}", value, digits);
}

OrderedJson TableJson(const Objective& objective, const Evaluation& table) {
  OrderedJson json{{"seeds", SeedsText(objective)},
                   {"distance", TableDistance(table)},
                   {"rows", OrderedJson::array()}};
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    json["rows"].push_back(RowJson(objective.problem().target[row], table.rows[row]));
  }
  return json;
}

OrderedJson SetJson(const EnsembleReport& report, std::size_t index) {
  const ParameterSet& set = report.found.sets[index];
  OrderedJson values = OrderedJson::object();
  for (const FieldValue& change : report.searched.Changes(set.values)) {
    values[change.pointer] = change.value;
  }
  return {{"file", SetFileName(index)},
          {"values", std::move(values)},
          {"search", TableJson(report.searched, set.searched)},
          {"fresh", TableJson(report.fresh, set.fresh)}};
}

OrderedJson FieldsJson(const CalibrationProblem& problem) {
  OrderedJson json = OrderedJson::array();
  for (const FreeField& field : problem.fields) {
    json.push_back({{"pointer", field.pointer()},
                    {"lowest", field.lowest()},
                    {"highest", field.highest()},
                    {"scale", field.is_logarithmic() ? "log" : "linear"}});
  }
  return json;
}

}  // namespace

std::string SetFileName(std::size_t index) { return fmt::format("set-{}.json", index + 1); }

std::string WithOrigin(const EnsembleReport& report, std::size_t index, std::string_view text) {
  const CalibrationProblem& problem = report.searched.problem();
  const std::string derived =
      problem.steady ? ", except the gaps, which follow from them (--steady)" : "";
  const std::string titled = WithValue(
      text, "/title", Quote(fmt::format("{}, set {}", problem.scenario.title, index + 1)));
  return WithValue(
      titled, "/description",
      Quote(fmt::format("Set {} of an ensemble: its table is within {} of the target, "
                        "over seeds {} and over seeds {}. The fields after --free were found by a "
                        "search; the others are those of {}{}. Made by: {}",
                        index + 1, PointsText(report.rules.within), SeedsText(report.searched),
                        SeedsText(report.fresh), report.scenario, derived, report.command)));
}

std::string SetText(const EnsembleReport& report, std::size_t index, std::string_view text) {
  std::string set = WithOrigin(report, index, text);
  for (const FieldValue& change : report.searched.Changes(report.found.sets[index].values)) {
    set = WithValue(set, change.pointer, NumberText(change.value));
  }
  return set;
}

std::string EnsembleSummary(const EnsembleReport& report) {
  const EnsembleCounts& counts = report.found.counts;
  std::string text = fmt::format(
      "{} of {} sets, within {} of the target over seeds {} and {}\n"
      "{} searches, {} tables: {} did not meet the target, {} came too near to another set, {} "
      "failed on fresh seeds\n",
      report.found.sets.size(), report.rules.sets, PointsText(report.rules.within),
      SeedsText(report.searched), SeedsText(report.fresh), counts.searches, counts.evaluations,
      counts.missed, counts.too_near, counts.rejected);
  if (report.found.sets.size() > 1) {
    text += fmt::format("least distance of two sets: {:.3f} (at least {:g})\n",
                        LeastDistance(report.searched.problem(), report.found.sets),
                        report.rules.apart);
  }
  return text;
}

std::string EnsembleText(const EnsembleReport& report) {
  std::string text =
      fmt::format("{}\n{}", report.searched.problem().scenario.title, EnsembleSummary(report));
  if (report.found.sets.empty()) return text;
  text += fmt::format("\n  {:<36}{:>18}", "", "searched or seeds");
  for (std::size_t i = 0; i < report.found.sets.size(); ++i) {
    text += fmt::format("{:>10}", fmt::format("set-{}", i + 1));
  }
  text += "\n";
  for (const QuantityLine& line : LinesOf(report)) {
    const std::string searched =
        line.lowest.empty() ? line.kind : fmt::format("[{}, {}]", line.lowest, line.highest);
    text += fmt::format("  {:<36}{:>18}", WithUnit(line.name, line.unit), searched);
    for (const double value : line.values) {
      constexpr int kDigits = 5;
      text += fmt::format("{:>10}", NumberOrNothing(value, kDigits));
    }
    text += "\n";
  }
  return text;
}

std::string EnsembleCsv(const EnsembleReport& report) {
  std::string csv = "quantity,unit,lowest,highest,scale_or_seeds";
  for (std::size_t i = 0; i < report.found.sets.size(); ++i) csv += fmt::format(",set-{}", i + 1);
  csv += "\n";
  for (const QuantityLine& line : LinesOf(report)) {
    csv +=
        fmt::format("{},{},{},{},{}", line.name, line.unit, line.lowest, line.highest, line.kind);
    for (const double value : line.values) {
      csv += fmt::format(",{}", std::isnan(value) ? "" : NumberText(value));
    }
    csv += "\n";
  }
  return csv;
}

std::string EnsembleJson(const EnsembleReport& report) {
  const EnsembleCounts& counts = report.found.counts;
  OrderedJson json{{"scenario", report.scenario},
                   {"command", report.command},
                   {"interrupted", report.found.interrupted},
                   {"within_points", report.rules.within},
                   {"least_distance", LeastDistance(report.searched.problem(), report.found.sets)},
                   {"tables", counts.evaluations},
                   {"searches", counts.searches},
                   {"missed", counts.missed},
                   {"too_near", counts.too_near},
                   {"rejected", counts.rejected},
                   {"fields", FieldsJson(report.searched.problem())},
                   {"sets", OrderedJson::array()}};
  for (std::size_t i = 0; i < report.found.sets.size(); ++i) {
    json["sets"].push_back(SetJson(report, i));
  }
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace fogline::calibrate
