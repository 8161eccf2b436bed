// Finds the values of a scenario's free fields with which the scenario's table of SI and RHE is
// nearest to a target table. Also finds the influence of each field on the table.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "tools/calibrate/objective.h"

namespace fogline::calibrate {

/// Progress of a search: evaluations so far, and the smallest objective among them.
using SearchProgress = std::function<void(int evaluations, double best)>;

/// Result of a search.
struct Calibration {
  std::vector<double> values;  // best values of the free fields
  Evaluation best;
  std::optional<double> objective_at_start;  // empty if the scenario cannot run at the first point
  int evaluations = 0;
  bool interrupted = false;
};

/// Searches for the values with the smallest objective. The search starts at the scenario's own
/// values; a value outside its bounds is moved to the bound. The first part of the search covers
/// the whole range, and the second part only the neighbourhood of the best point. The search ends
/// early when the table meets the target. The result depends only on the problem and on the number
/// of evaluations. The result is empty if `go_on` returned false before the first evaluation was
/// complete.
/// @param max_evaluations at least 1
/// @throws InputError if the scenario cannot run at any evaluated point
std::optional<Calibration> Calibrate(const Objective& objective, int max_evaluations,
                                     const GoOn& go_on, const SearchProgress& progress);

/// Change of a row of the table, in percentage points, when a field changes by 1 % of its range.
struct Change {
  std::optional<double> si_pct;
  std::optional<double> rhe_pct;
};

/// For each free field, the change of each row of the table.
using SensitivityTable = std::vector<std::vector<Change>>;

/// The sensitivity of the table to each free field, by central differences at `values`. A number is
/// changed by half a percent of its range in both directions. An integer is changed by one in both
/// directions, and the difference is scaled to a change by 1 % of the range. At a bound the
/// difference is one-sided. The result is empty if `go_on` returned false.
std::optional<SensitivityTable> Sensitivities(const Objective& objective,
                                              const std::vector<double>& values, const GoOn& go_on);

}  // namespace fogline::calibrate
