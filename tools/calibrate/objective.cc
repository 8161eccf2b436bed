#include "tools/calibrate/objective.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"
#include "tools/calibrate/steady_start.h"
#include "tools/sweep/engine.h"
#include "tools/sweep/threshold_curve.h"

namespace fogline::calibrate {
namespace {

// Residual, in points, of a seed whose runs do not have the measure. A published SI is in
// [-1000, 100] %. The value is the largest magnitude in this range.
constexpr double kMissingResidualPts = 1000;

double Square(double x) { return x * x; }

/// Mean over the seeds of the squared residual of a measure. Seeds whose runs have a value of the
/// measure all have the same residual: the mean of these values, minus the target. A seed without a
/// value has the residual kMissingResidualPts. The result is 0 without a target.
double Residual(const stats::Statistics& reached, const std::optional<double>& target,
                std::int64_t seeds) {
  if (!target) return 0;
  const double missing = static_cast<double>(seeds - reached.count()) / static_cast<double>(seeds);
  const double present = reached.mean() ? Square(*reached.mean() - *target) : 0;
  return (1 - missing) * present + missing * Square(kMissingResidualPts);
}

}  // namespace

Objective::Objective(CalibrationProblem problem)
    : problem_(std::move(problem)), thresholds_{.pointer = "/arbitrator/threshold", .values = {}} {
  sweep::RequireThreshold(problem_.scenario, problem_.file);
  for (const TargetRow& row : problem_.target) {
    thresholds_.values.push_back(NumberText(row.threshold));
  }
  for (const FreeField& field : problem_.fields) {
    if (problem_.steady && std::ranges::find(kSteadyFields, field.pointer()) != kSteadyFields.end())
      throw InputError(fmt::format("error: --free {}: --steady derives it", field.pointer()));
  }
}

std::vector<double> Objective::ValuesAt(std::span<const double> shares) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    values.push_back(problem_.fields[i].ValueAt(shares[i]));
  }
  return values;
}

Scenario Objective::With(std::span<const double> values) const {
  Scenario scenario = problem_.scenario;
  for (std::size_t i = 0; i < values.size(); ++i) problem_.fields[i].Set(scenario, values[i]);
  if (problem_.steady) StartSteadily(scenario);
  return scenario;
}

std::vector<FieldValue> Objective::Changes(std::span<const double> values) const {
  std::vector<FieldValue> changes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    changes.push_back({problem_.fields[i].pointer(), values[i]});
  }
  if (!problem_.steady) return changes;
  Scenario scenario = With(values);
  for (const DerivedField& derived : StartSteadily(scenario)) {
    changes.push_back({std::string(derived.pointer), derived.value});
  }
  return changes;
}

std::string Objective::NameOf(std::span<const double> values) const {
  std::string name;
  for (std::size_t i = 0; i < values.size(); ++i) {
    name += fmt::format("{}{}={}", i == 0 ? "" : ", ", problem_.fields[i].pointer(),
                        NumberText(values[i]));
  }
  return name;
}

std::optional<Evaluation> Objective::Evaluate(std::span<const double> values,
                                              const GoOn& go_on) const {
  Evaluation evaluation;
  evaluation.rows.resize(problem_.target.size());
  bool complete = true;
  try {
    const sweep::SweepPlan plan(With(values), {thresholds_}, problem_.seeds, problem_.file);
    sweep::RunSweep(plan, 0, plan.units(), problem_.jobs,
                    [&](std::int64_t, const std::vector<sweep::SweepRow>& results) {
                      for (std::size_t i = 0; i < results.size(); ++i) {
                        TableRow& row = evaluation.rows[i];
                        const std::optional<double>& si_pct = results[i].paired.si_pct;
                        if (si_pct) row.si_pct.Add(*si_pct);
                        if (results[i].measures.rhe_pct)
                          row.rhe_pct.Add(*results[i].measures.rhe_pct);
                      }
                      return complete = go_on();
                    });
  } catch (const InputError& error) {
    // Values that are valid one by one can be invalid together, such as the weights of an ACC.
    return Evaluation{.rows = {},
                      .objective = std::numeric_limits<double>::max(),
                      .refusal = fmt::format("{} with {}", error.what(), NameOf(values))};
  }
  if (!complete) return std::nullopt;
  evaluation.objective = Sum(evaluation.rows);
  return evaluation;
}

double Objective::Sum(const std::vector<TableRow>& rows) const {
  const std::int64_t seeds = problem_.seeds.count();
  double sum = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const TargetRow& target = problem_.target[i];
    sum += Residual(rows[i].si_pct, target.si_pct, seeds);
    sum += problem_.rhe_weight * Residual(rows[i].rhe_pct, target.rhe_pct, seeds);
    if (target.si_pct) {
      sum += problem_.spread_weight * Square(rows[i].si_pct.deviation().value_or(0));
    }
  }
  return sum;
}

}  // namespace fogline::calibrate
