// The tables of the report's page, as HTML.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "tools/report/curves.h"
#include "tools/report/report.h"

namespace fogline::report {

/// The table of SI and RHE at each threshold: the values of our runs beside the published values.
std::string ThresholdTable(const ReportTable& table);

/// All values of the curves, one row for each threshold. `points` says which thresholds are on the
/// Pareto front.
std::string CurveTable(const ReportCurves& curves, std::span<const FrontPoint> points);

/// Every measure that any run has: one row for each measure, one column for each run.
std::string MetricTable(std::span<const ReportRun> runs);

/// The measures of requests to take over: one row for each measure, one column for each request.
/// "" if no run has a request.
std::string TakeOverTable(std::span<const ReportRun> runs);

/// The scenario fields in which the runs differ, with one column for each run; "" if there are
/// none.
std::string DifferenceTable(std::span<const ReportRun> runs);

/// Name of a run, or its number if it has no name.
std::string RunName(std::span<const ReportRun> runs, std::size_t index);

/// Text of a badge for a run whose log is not complete; "" for a complete log. If the last step is
/// missing, the text says after which step the log ends.
std::string BadgeOf(const ReportRun& run);

}  // namespace fogline::report
