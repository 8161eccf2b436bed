// What the page's script draws: figures and runs as JSON.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "tools/report/report.h"

namespace fogline {

/// JSON text: {"figures": [...], "columns": [[...], ...], "runs": [...], "curves": {...} or null}.
/// A run names its columns by their places in "columns", where equal ones stand once: curves that
/// runs share have one place. Their numbers are rounded to 1e-6; NaN is null.
std::string PageData(std::span<const ReportRun> runs,
                     const std::optional<ReportCurves>& curves = std::nullopt);

}  // namespace fogline
