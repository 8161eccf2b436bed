// The table that a calibration is to meet.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "scenario/scenario.h"

namespace fogline {

/// What a row of the table shall be; a number that is not there does not matter.
struct TargetRow {
  double threshold = 0;
  std::optional<double> si_pct;
  std::optional<double> rhe_pct;
};

/// The rows of {"rows": [{"threshold": 0.5, "si_pct": 80.79, "rhe_pct": 0}]}, which is also what
/// `fogline table --json` prints. Other keys are passed over; null stands for a number that is not
/// there.
/// @throws InputError with every mistake and its place
std::vector<TargetRow> ReadTarget(const std::filesystem::path& file);

/// The published rows of a scenario.
std::vector<TargetRow> PublishedTarget(const Scenario& scenario);

}  // namespace fogline
