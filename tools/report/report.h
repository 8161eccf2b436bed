// The report of runs: one self-contained HTML page, and figures as files for a paper. This library
// draws what it is given. It reads no log and runs nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "services/measures/sample.h"
#include "tools/sweep/statistics.h"

namespace fogline {

/// One number that judges a run.
struct ReportMeasure {
  std::string name;
  double value = 0;  // NaN where the run gives none
  std::string unit;  // "" if none
  std::string description;
};

/// One run, as the report shows it. Every text may hold anything; it is escaped.
struct ReportRun {
  std::string name;        // such as "threshold 0.5", or the name of its log
  std::string log;         // name of its log; "" if there is none
  std::string shortage;    // what its log lacks; "" if it is complete
  Scenario scenario = {};  // as run: how the LiDAR is mounted, who may drive, how many steps
  std::string scenario_title;
  std::string scenario_json;  // the effective scenario; shown folded, and compared between runs
  std::int64_t seed = 0;
  std::string digest;
  std::vector<Sample> samples;  // in the order of time
  std::vector<ReportMeasure> measures;
  std::optional<double> si_pct =
      {};  // safety improvement over the paired run without traded control
};

/// The paper's table. Standard deviations are those over seeds; published values come from the
/// scenario.
struct ReportTable {
  struct Row {
    double threshold = 0;
    std::optional<std::int64_t> seed = {};  // where rows are of several seeds
    double si_pct = 0;                      // NaN where no seed has one
    double rhe_pct = 0;
    std::optional<double> si_std_pct = {};
    std::optional<double> rhe_std_pct = {};
    std::optional<double> published_si_pct = {};
    std::optional<double> published_rhe_pct = {};
  };
  std::vector<Row> rows;
  std::string note;  // such as "mean and standard deviation over seeds 1 to 200"; "" if none
};

/// SI and RHE against the threshold, over seeds.
struct ReportCurves {
  struct Point {
    double threshold = 0;
    Summary si_pct;  // of the seeds that have one
    Summary rhe_pct;
  };
  std::string scenario_title;
  std::int64_t first_seed = 1;
  std::int64_t last_seed = 1;
  std::vector<Point> points;  // in ascending order of thresholds, which are distinct
  std::vector<PublishedRow> published;
};

/// The whole page. It refers to nothing outside itself.
std::string MakeReport(std::span<const ReportRun> runs, const std::optional<ReportTable>& table,
                       const std::optional<ReportCurves>& curves = std::nullopt);

/// What a figure is written as: pixels, or lines that can be enlarged.
enum class FigureFormat { kPng, kSvg, kPdf };

/// Writes one file for each figure into `dir` (made if missing), with gnuplot: a panel for each
/// run, all with the same axes. Files are named figure-1-speeds.png and so on.
/// @throws std::runtime_error with gnuplot's own words if it fails or is not installed
void WriteFigures(const std::filesystem::path& dir, FigureFormat format,
                  std::span<const ReportRun> runs);

/// The same for the curves: figure-a-thresholds.png and figure-b-front.png.
/// @throws std::runtime_error likewise
void WriteCurveFigures(const std::filesystem::path& dir, FigureFormat format,
                       const ReportCurves& curves);

}  // namespace fogline
