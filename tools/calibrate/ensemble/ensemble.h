// Finds several distinct sets of values for a scenario's free fields. With each set, the scenario's
// table (SI and RHE at several thresholds) is close to a target table. This holds over the seeds of
// the search, and also over fresh seeds, which the search does not use.
#pragma once

#include <vector>

#include "tools/calibrate/ensemble/ensemble_search.h"
#include "tools/calibrate/objective.h"

namespace fogline::calibrate {

/// One set of values. `searched` is the scenario's table over the seeds of the search, and `fresh`
/// is its table over the fresh seeds.
struct ParameterSet {
  std::vector<double> values;  // of the free fields
  Evaluation searched;
  Evaluation fresh;
};

struct ParameterEnsemble {
  std::vector<ParameterSet> sets;
  EnsembleCounts counts;
  bool interrupted = false;
};

/// Distance of a table from its target: the square root of the objective, in points. The objective
/// also contains the weighted variance of SI over the seeds.
double TableDistance(const Evaluation& evaluation);

/// The values of the free fields as shares of the fields' ranges, in [0, 1].
std::vector<double> SharesOf(const CalibrationProblem& problem, const std::vector<double>& values);

/// Least distance (ShareDistance()) between two of the sets; 1 for a single set.
double LeastDistance(const CalibrationProblem& problem, const std::vector<ParameterSet>& sets);

/// The problem with the seeds `fresh` instead of the seeds of the search.
/// @throws InputError if both ranges of seeds have a seed in common
CalibrationProblem WithFreshSeeds(CalibrationProblem problem, sweep::SeedRange fresh);

/// Searches for an ensemble. `fresh` is the problem of `searched` with other seeds. The result does
/// not depend on the number of threads. An interrupted search returns the sets found so far.
/// @throws InputError if the scenario cannot run at any evaluated point
ParameterEnsemble FindEnsemble(const Objective& searched, const Objective& fresh,
                               const EnsembleRules& rules, const GoOn& go_on,
                               const EnsembleProgress& progress);

}  // namespace fogline::calibrate
