// Finds distinct values of a scenario's free fields, each of which meets a target table: over the
// seeds of the search, and over fresh seeds that the search does not use.
#pragma once

#include <vector>

#include "tools/calibrate/ensemble/ensemble_search.h"
#include "tools/calibrate/objective.h"

namespace fogline::calibrate {

/// One set of values, and the tables that it gives.
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

/// Distance of a table from its target: the root of the objective, in points. It contains the
/// spread over the seeds by its weight.
double TableDistance(const Evaluation& evaluation);

/// The values as shares of their ranges.
std::vector<double> SharesOf(const CalibrationProblem& problem, const std::vector<double>& values);

/// Least distance between two of the sets; 1 for a single set.
double LeastDistance(const CalibrationProblem& problem, const std::vector<ParameterSet>& sets);

/// The problem with fresh seeds in place of those of the search.
/// @throws InputError if a seed is among both
CalibrationProblem WithFreshSeeds(CalibrationProblem problem, sweep::SeedRange fresh);

/// Searches for an ensemble. `fresh` is the same problem with other seeds. The result does not
/// depend on the number of threads. An interrupted search keeps what it has found.
/// @throws InputError if the scenario can run at no evaluated point
ParameterEnsemble FindEnsemble(const Objective& searched, const Objective& fresh,
                               const EnsembleRules& rules, const GoOn& go_on,
                               const EnsembleProgress& progress);

}  // namespace fogline::calibrate
