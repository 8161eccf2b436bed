// What the figures of the curves over thresholds show, for the page and the files of figures alike.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tools/report/report.h"

namespace fogline {

/// A place in the plane of mean RHE and mean SI. Thresholds that agree in both share it.
struct FrontPoint {
  double rhe_pct = 0;
  double si_pct = 0;
  std::vector<std::size_t> rows;  // places of its thresholds in the curves, ascending
  std::string thresholds;  // such as "0.36", or "0.01–0.27" for all that the curves have from to
  bool on_front = false;
  bool beside = true;  // whether a label has room to the right: no flat piece of the front is there
};

/// All places, by ascending RHE, then SI. Thresholds without SI or RHE have none.
std::vector<FrontPoint> FrontPoints(const ReportCurves& curves);

/// Places of the points that deserve a label, the first ones most: those with a tenth among their
/// thresholds (the more thresholds the better), then the front.
std::vector<std::size_t> LabelOrder(const ReportCurves& curves, std::span<const FrontPoint> points);

/// "seeds 1 to 200", "seed 7".
std::string SeedsText(const ReportCurves& curves);

/// The figures' frames on the page, a slider for the threshold, and all values as a table.
std::string CurvesContent(const ReportCurves& curves);

/// JSON text of what the page's script draws.
std::string CurvesData(const ReportCurves& curves);

}  // namespace fogline
