// Data for the script of the report's HTML page: figures and runs as JSON.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "tools/report/report.h"

namespace fogline::report {

/// JSON text: {"figures": [...], "columns": [[...], ...], "runs": [...], "curves": {...} or null}.
/// A run refers to its columns by their indices in "columns". Equal columns are stored once, so
/// runs with equal curves share an index. Numbers of columns are rounded to 1e-6; NaN is null.
std::string PageData(std::span<const ReportRun> runs,
                     const std::optional<ReportCurves>& curves = std::nullopt);

}  // namespace fogline::report
