// Results of a calibration, as text for people and as JSON for programs.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tools/calibrate/calibrate.h"

namespace fogline::calibrate {

struct Findings {
  Calibration calibration;
  std::optional<SensitivityTable> sensitivities;  // empty if the search was interrupted
};

/// A row of the table in the form of `fogline table --json`, with the target added.
nlohmann::ordered_json RowJson(const TargetRow& target, const TableRow& row);

/// Values, residuals (differences from the target) and sensitivities as tables.
std::string FindingsText(const CalibrationProblem& problem, const Findings& findings);

/// The findings as JSON. "rows" has the rows of `fogline table --json`, each with the target added.
/// @param scenario name of the scenario's file
std::string FindingsJson(const CalibrationProblem& problem, const Findings& findings,
                         const std::string& scenario);

}  // namespace fogline::calibrate
