#include "tools/sweep/threshold_curve.h"

#include <cstddef>

#include <fmt/format.h>

#include "common/errors.h"
#include "common/text.h"
#include "services/decision/policies/policies.h"
#include "tools/sweep/engine.h"

namespace fogline::sweep {

void RequireThreshold(const Scenario& scenario, const std::filesystem::path& file) {
  const policies::PolicyRow& policy = policies::RowOf(scenario.arbitrator.policy);
  if (policy.uses_threshold) return;
  std::string others;
  for (const policies::PolicyRow& row : policies::Policies()) {
    if (row.uses_threshold) others += fmt::format("{}{}", others.empty() ? "" : ", ", row.name);
  }
  throw InputError(fmt::format(
      "{}: error: /arbitrator/policy is {}, which uses no threshold; these policies do: {}",
      PathText(file), policy.name, others));
}

std::vector<ThresholdRow> SweepThresholds(const Scenario& scenario,
                                          std::span<const double> thresholds,
                                          const SeedRange& seeds, int jobs, const SeedsDone& done) {
  Axis axis{.pointer = "/arbitrator/threshold", .values = {}};
  std::vector<ThresholdRow> rows;
  for (const double threshold : thresholds) {
    axis.values.push_back(fmt::format("{}", threshold));
    rows.emplace_back().threshold = threshold;
  }
  // A unit of this plan has the rows of one seed: a row for each threshold. These rows share one
  // paired run.
  const SweepPlan plan(scenario, {axis}, seeds);
  RunSweep(plan, 0, plan.units(), jobs,
           [&](std::int64_t unit, const std::vector<SweepRow>& results) {
             for (std::size_t i = 0; i < rows.size(); ++i) {
               rows[i].Add(results[i].measures, results[i].paired, results[i].without);
             }
             return done(unit + 1);
           });
  return rows;
}

}  // namespace fogline::sweep
