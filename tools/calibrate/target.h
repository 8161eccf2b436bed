// The target table of a calibration.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "scenario/sections/scenario.h"

namespace fogline::calibrate {

/// A target row. A missing number does not count in the objective.
struct TargetRow {
  double threshold = 0;
  std::optional<double> si_pct;
  std::optional<double> rhe_pct;
};

/// Reads the rows of a target file. The file has the form that `fogline table --json` prints:
/// {"rows": [{"threshold": 0.5, "si_pct": 80.79, "rhe_pct": 0}]}. Other keys are ignored. null
/// marks a missing number.
/// @throws InputError; its text has every mistake, with its position in the file
std::vector<TargetRow> ReadTarget(const std::filesystem::path& file);

/// The published rows of a scenario.
std::vector<TargetRow> PublishedTarget(const Scenario& scenario);

}  // namespace fogline::calibrate
