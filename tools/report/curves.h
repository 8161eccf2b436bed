// Content of the figures that show curves over thresholds, for the report's HTML page and for the
// figure files.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tools/report/report.h"

namespace fogline::report {

/// A point in the plane of mean RHE and mean SI. Thresholds with equal RHE and equal SI share one
/// point. A point is on the front (the Pareto front) if no other point has at least as much SI with
/// at most as much RHE.
struct FrontPoint {
  double rhe_pct = 0;
  double si_pct = 0;
  std::vector<std::size_t> rows;  // ascending indices of the point's thresholds in the curves
  // The point's thresholds as text, such as "0.36" or "0.01–0.27, 0.3". A range "0.01–0.27" means
  // these two thresholds and all thresholds of the curves between them.
  std::string thresholds;
  bool on_front = false;
  // Whether a label has room to the right of the point. It has no room if the front rises only
  // slowly from this point to the next point.
  bool beside = true;
};

/// All points, by ascending RHE, then SI. Thresholds without SI or RHE have no point.
std::vector<FrontPoint> FrontPoints(const ReportCurves& curves);

/// Indices of the points that may get a label, the most important first. The list begins with the
/// points that have a multiple of 0.1 among their thresholds; of these, points with more thresholds
/// come first. The other points on the front follow.
std::vector<std::size_t> LabelOrder(const ReportCurves& curves, std::span<const FrontPoint> points);

/// The seeds as text, such as "seeds 1 to 200" or "seed 7".
std::string SeedsText(const ReportCurves& curves);

/// HTML of the section of these curves: frames of the figures, a slider for the threshold, and all
/// values as a table.
std::string CurvesContent(const ReportCurves& curves);

/// JSON text with the data that the page's script draws.
std::string CurvesData(const ReportCurves& curves);

}  // namespace fogline::report
