#include "tools/calibrate/fit.h"

#include <cstddef>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/json.h"
#include "common/text.h"

namespace fogline::calibrate {
namespace {

using Json = nlohmann::ordered_json;
using Number = std::optional<double>;

Number Difference(Number reached, Number target) {
  return reached && target ? Number(*reached - *target) : std::nullopt;
}

Json FieldJson(const CalibrationProblem& problem, const Findings& findings, std::size_t i) {
  const FreeField& field = problem.fields[i];
  Json json{{"pointer", field.pointer()},
            {"value", findings.calibration.values[i]},
            {"before", field.Get(problem.scenario)},
            {"lowest", field.lowest()},
            {"highest", field.highest()},
            {"scale", field.is_logarithmic() ? "log" : "linear"}};
  if (!findings.sensitivities) return json;
  Json& rows = json["change_per_percent_of_range"] = Json::array();
  for (std::size_t row = 0; row < problem.target.size(); ++row) {
    const Change& change = (*findings.sensitivities)[i][row];
    rows.push_back({{"threshold", problem.target[row].threshold},
                    {"si_pct", OrNull(change.si_pct)},
                    {"rhe_pct", OrNull(change.rhe_pct)}});
  }
  return json;
}

std::string Cell(Number value) { return value ? fmt::format("{:.2f}", *value) : "-"; }
std::string Signed(Number value) { return value ? fmt::format("{:+.2f}", *value) : "-"; }

std::string FieldsText(const CalibrationProblem& problem, const std::vector<double>& values) {
  std::string text = fmt::format("  {:<36}{:>14}{:>14}  searched\n", "field", "before", "found");
  for (std::size_t i = 0; i < problem.fields.size(); ++i) {
    const FreeField& field = problem.fields[i];
    text += fmt::format(
        "  {:<36}{:>14.6g}{:>14.6g}  {}{}\n", field.pointer(), field.Get(problem.scenario),
        values[i],
        WithUnit(fmt::format("[{}, {}]", NumberText(field.lowest()), NumberText(field.highest())),
                 field.unit()),
        field.is_logarithmic() ? ", logarithmic" : "");
  }
  return text;
}

/// Target, reached mean, difference and standard deviation of one measure.
std::string Measure(const stats::Statistics& reached, Number target) {
  return fmt::format("{:>10}{:>10}{:>12}{:>8}", Cell(target), Cell(reached.mean()),
                     Signed(Difference(reached.mean(), target)), Cell(reached.deviation()));
}

std::string ResidualsText(const CalibrationProblem& problem, const std::vector<TableRow>& rows) {
  constexpr std::string_view kHead = "    target   reached  difference     std";
  std::string text = fmt::format("  {:>6}{:>40}{:>40}\n  {:>6}{}{}\n", "", "SI (%)", "RHE (%)",
                                 "DoC_th", kHead, kHead);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const TargetRow& target = problem.target[i];
    text += fmt::format("  {:>6g}{}{}\n", target.threshold, Measure(rows[i].si_pct, target.si_pct),
                        Measure(rows[i].rhe_pct, target.rhe_pct));
    if (rows[i].si_pct.count() < problem.seeds.count()) {
      text += fmt::format(
          "          SI of {} seeds: the others have no compromised safety to improve\n",
          rows[i].si_pct.count());
    }
  }
  return text;
}

std::string SensitivitiesText(const CalibrationProblem& problem, const SensitivityTable& table) {
  std::string text = "  Points that 1 % of a field's range changes\n";
  text += fmt::format("  {:<36}", "field");
  for (const char* measure : {"SI", "RHE"}) {
    for (const TargetRow& row : problem.target) {
      text += fmt::format("{:>10}", fmt::format("{} {:g}", measure, row.threshold));
    }
  }
  text += "\n";
  for (std::size_t i = 0; i < table.size(); ++i) {
    text += fmt::format("  {:<36}", problem.fields[i].pointer());
    for (const Change& change : table[i]) text += fmt::format("{:>10}", Signed(change.si_pct));
    for (const Change& change : table[i]) text += fmt::format("{:>10}", Signed(change.rhe_pct));
    text += "\n";
  }
  return text;
}

}  // namespace

Json RowJson(const TargetRow& target, const TableRow& row) {
  return {{"threshold", target.threshold},
          {"si_pct", OrNull(row.si_pct.mean())},
          {"rhe_pct", OrNull(row.rhe_pct.mean())},
          {"si_std_pct", OrNull(row.si_pct.deviation())},
          {"rhe_std_pct", OrNull(row.rhe_pct.deviation())},
          {"si_seeds", row.si_pct.count()},
          {"target_si_pct", OrNull(target.si_pct)},
          {"target_rhe_pct", OrNull(target.rhe_pct)},
          {"si_difference_pct", OrNull(Difference(row.si_pct.mean(), target.si_pct))},
          {"rhe_difference_pct", OrNull(Difference(row.rhe_pct.mean(), target.rhe_pct))}};
}

std::string FindingsText(const CalibrationProblem& problem, const Findings& findings) {
  const Calibration& found = findings.calibration;
  const std::int64_t seeds = problem.seeds.count();
  std::string text =
      fmt::format("{}\n{} seed{}, {} evaluation{}; objective {:.4g}", problem.scenario.title, seeds,
                  seeds == 1 ? "" : "s", found.evaluations, found.evaluations == 1 ? "" : "s",
                  found.best.objective);
  if (found.objective_at_start)
    text += fmt::format(", {:.4g} at the start", *found.objective_at_start);
  text += fmt::format("\n\n{}\n{}", FieldsText(problem, found.values),
                      ResidualsText(problem, found.best.rows));
  if (findings.sensitivities) {
    text += fmt::format("\n{}", SensitivitiesText(problem, *findings.sensitivities));
  }
  return text;
}

std::string FindingsJson(const CalibrationProblem& problem, const Findings& findings,
                         const std::string& scenario) {
  const Calibration& found = findings.calibration;
  Json json{{"scenario", scenario},
            {"seeds", problem.seeds.count()},
            {"evaluations", found.evaluations},
            {"interrupted", found.interrupted},
            {"objective", found.best.objective},
            {"objective_at_start", OrNull(found.objective_at_start)},
            {"fields", Json::array()},
            {"rows", Json::array()}};
  for (std::size_t i = 0; i < problem.fields.size(); ++i) {
    json["fields"].push_back(FieldJson(problem, findings, i));
  }
  for (std::size_t i = 0; i < problem.target.size(); ++i) {
    json["rows"].push_back(RowJson(problem.target[i], found.best.rows[i]));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace fogline::calibrate
