// What a calibration found, for a person and for programs.
#pragma once

#include <optional>
#include <string>

#include "tools/calibrate/calibrate.h"

namespace fogline {

struct Findings {
  Calibration calibration;
  std::optional<SensitivityTable> sensitivities;  // none where it was interrupted
};

/// Values, residuals and sensitivities as tables.
std::string FindingsText(const CalibrationProblem& problem, const Findings& findings);

/// The same as JSON; "rows" are those of `fogline table --json` with the target beside them.
/// @param scenario name of the scenario's file
std::string FindingsJson(const CalibrationProblem& problem, const Findings& findings,
                         const std::string& scenario);

}  // namespace fogline
