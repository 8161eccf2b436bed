// Curves that look like those of the experiment, for tests of the report. SI falls from 100 % to 0;
// RHE falls earlier and faster. The curves are a rough sketch without simulation.
#pragma once

#include <algorithm>
#include <cmath>

#include "tools/report/report.h"

namespace fogline {

inline stats::Summary ExampleSummary(double mean, double deviation) {
  return {.count = 200,
          .mean = mean,
          .deviation = deviation,
          .ci95 = 0.14 * deviation,
          .p5 = mean - 1.6 * deviation,
          .p95 = mean + 1.6 * deviation};
}

/// Thresholds 0.01 to 0.99. All points up to 0.2 have equal values, and all points from 0.85 on
/// have equal values.
inline report::ReportCurves ExampleCurves() {
  report::ReportCurves curves{
      .scenario_title = "Traded control in fog",
      .first_seed = 1,
      .last_seed = 200,
      .points = {},
      .published = {{0.2, 100.0, 100.0}, {0.5, 80.79, 0.0}, {0.8, 10.23, 0.0}}};
  for (int i = 1; i <= 99; ++i) {
    const double threshold = i / 100.0;
    const double si = std::clamp((0.85 - threshold) / 0.0063, 0.0, 100.0);
    const double rhe = threshold <= 0.2 ? 100.0 : 100.0 / (1.0 + std::exp(60 * (threshold - 0.3)));
    curves.points.push_back({.threshold = threshold,
                             .si_pct = ExampleSummary(si, si > 0 && si < 100 ? 3.0 : 0.0),
                             .rhe_pct = ExampleSummary(threshold < 0.5 ? rhe : 0.0, 0.0)});
  }
  return curves;
}

}  // namespace fogline
