// The tables of the page, as HTML.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "tools/report/curves.h"
#include "tools/report/report.h"

namespace fogline {

/// The reproduced table beside the published one.
std::string ThresholdTable(const ReportTable& table);

/// All values of the curves, a row for each threshold; `points` say which are on the front.
std::string CurveTable(const ReportCurves& curves, std::span<const FrontPoint> points);

/// Every measure that any run has, a row each, the runs side by side.
std::string MeasureTable(std::span<const ReportRun> runs);

/// The scenario fields in which the runs differ, the runs side by side; "" if there are none.
std::string DifferenceTable(std::span<const ReportRun> runs);

/// Name of a run, or its number if it has none.
std::string RunName(std::span<const ReportRun> runs, std::size_t index);

/// Says of a run whose log is not complete where it ends; "" if it is complete.
std::string BadgeOf(const ReportRun& run);

}  // namespace fogline
