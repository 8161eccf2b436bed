#include "tools/calibrate/ensemble/ensemble.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"

namespace fogline::calibrate {

double TableDistance(const Evaluation& evaluation) { return std::sqrt(evaluation.objective); }

std::vector<double> SharesOf(const CalibrationProblem& problem, const std::vector<double>& values) {
  std::vector<double> shares;
  for (std::size_t i = 0; i < values.size(); ++i) {
    shares.push_back(problem.fields[i].ShareOf(values[i]));
  }
  return shares;
}

double LeastDistance(const CalibrationProblem& problem, const std::vector<ParameterSet>& sets) {
  double least = 1;
  for (std::size_t a = 0; a < sets.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      least = std::min(least, ShareDistance(SharesOf(problem, sets[a].values),
                                            SharesOf(problem, sets[b].values)));
    }
  }
  return least;
}

CalibrationProblem WithFreshSeeds(CalibrationProblem problem, sweep::SeedRange fresh) {
  if (fresh.first <= problem.seeds.last && problem.seeds.first <= fresh.last) {
    throw InputError(fmt::format("error: --fresh {}:{}: overlaps --seeds {}:{}", fresh.first,
                                 fresh.last, problem.seeds.first, problem.seeds.last));
  }
  problem.seeds = fresh;
  return problem;
}

ParameterEnsemble FindEnsemble(const Objective& searched, const Objective& fresh,
                               const EnsembleRules& rules, const GoOn& go_on,
                               const EnsembleProgress& progress) {
  std::string refusal;
  bool ran = false;
  const auto value_of = [&](const Objective& objective) {
    return [&, of = &objective](const std::vector<double>& shares) -> std::optional<double> {
      const std::optional<Evaluation> evaluation = of->Evaluate(of->ValuesAt(shares), go_on);
      if (!evaluation) return std::nullopt;
      if (evaluation->refusal.empty()) {
        ran = true;
      } else if (refusal.empty()) {
        refusal = evaluation->refusal;
      }
      return evaluation->objective;
    };
  };
  const CalibrationProblem& problem = searched.problem();
  const Landscape landscape{.fields = problem.fields.size(),
                            .searched = value_of(searched),
                            .fresh = value_of(fresh),
                            .rounded = [&](const std::vector<double>& shares) {
                              return SharesOf(problem, searched.ValuesAt(shares));
                            }};
  const PointEnsemble points = FindPoints(landscape, rules, progress);
  if (!ran && !refusal.empty()) throw InputError(refusal);
  ParameterEnsemble ensemble{
      .sets = {}, .counts = points.counts, .interrupted = points.interrupted};
  // The tables of the found points are computed even after an interrupt, because this is quick.
  const GoOn always = [] { return true; };
  for (const std::vector<double>& point : points.points) {
    const std::vector<double> values = searched.ValuesAt(point);
    ensemble.sets.push_back({.values = values,
                             .searched = *searched.Evaluate(values, always),
                             .fresh = *fresh.Evaluate(values, always)});
  }
  return ensemble;
}

}  // namespace fogline::calibrate
