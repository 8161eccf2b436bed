// Finds the values of a scenario's free fields that meet a table best, and how much each matters.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "tools/calibrate/objective.h"

namespace fogline {

/// How far a search is: evaluations so far, and the smallest objective among them.
using SearchProgress = std::function<void(int evaluations, double best)>;

/// What a search found.
struct Calibration {
  std::vector<double> values;  // of the free fields, the best so far
  Evaluation best;
  std::optional<double> objective_at_start;  // none if the scenario could not run there
  int evaluations = 0;
  bool interrupted = false;
};

/// Searches from the scenario's own values (moved into the bounds where they are outside), first
/// in the whole range, then about the best point; ends early when the table is met. The result
/// depends on the problem and on the number of evaluations alone. None if `go_on` said no before
/// the first evaluation was complete.
/// @param max_evaluations at least 1
/// @throws InputError if the scenario runs nowhere
std::optional<Calibration> Calibrate(const Objective& objective, int max_evaluations,
                                     const GoOn& go_on, const SearchProgress& progress);

/// What 1 % of a field's range changes in a row of the table, in points.
struct Change {
  std::optional<double> si_pct;
  std::optional<double> rhe_pct;
};

/// Of each free field the change of each row.
using SensitivityTable = std::vector<std::vector<Change>>;

/// By the difference between half a
/// percent of its range below and above `values`; one whole step to either side for an integer,
/// scaled; to one side only at a bound. None if `go_on` said no.
std::optional<SensitivityTable> Sensitivities(const Objective& objective,
                                              const std::vector<double>& values, const GoOn& go_on);

}  // namespace fogline
