// The report of runs: one self-contained HTML page, and figures as files for a paper. This library
// only draws its input. It reads no log and starts no run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/atomic_file.h"
#include "scenario/sections/scenario.h"
#include "services/metrics/fog_effect.h"
#include "services/metrics/sample.h"
#include "services/metrics/take_over/take_over_measures.h"
#include "tools/stats/statistics.h"

namespace fogline::report {

/// The value of a measure in a run.
struct ReportMetric {
  std::string name;
  double value = 0;  // NaN if the run has no value
  std::string unit;  // "" if the measure has no unit
  std::string description;
};

/// A run for the report. Every text may contain any characters; the library escapes it.
struct ReportRun {
  std::string name;        // such as "threshold 0.5", or the name of the run's log
  std::string log;         // name of the run's log; "" if there is no log
  std::string shortage;    // the part that the log lacks; "" if the log is complete
  bool ended = false;      // whether the log has the last step
  Scenario scenario = {};  // the effective scenario
  std::string scenario_title;
  std::string scenario_json;  // the effective scenario; shown folded, and compared between runs
  std::int64_t seed = 0;
  std::string digest;
  bool has_gaps = false;                 // whether messages before the end of the log are missing
  std::vector<metrics::Sample> samples;  // in order of time; without values where a step is missing
  std::vector<ReportMetric> measures;
  // Safety improvement compared with the paired run without traded control: in fog, and until the
  // track has recovered (metrics::PairedMetrics).
  std::optional<double> si_pct = {};
  std::optional<double> si_until_recovery_pct = {};
  std::vector<metrics::TakeOverMeasures> take_overs = {};  // one for each request to take over
  std::string unknown_measures = {};    // such as "rhe_pct, transfers"; "" if all are known
  std::string unknown_take_overs = {};  // the requests without measures; "" if there are none
};

/// The paper's table. Standard deviations are over seeds; published values come from the scenario.
struct ReportTable {
  struct Row {
    double threshold = 0;
    std::optional<std::int64_t> seed = {};  // set if rows have different seeds
    double si_pct = 0;                      // NaN if no seed has SI
    double rhe_pct = 0;
    std::optional<double> si_std_pct = {};
    std::optional<double> rhe_std_pct = {};
    std::optional<double> published_si_pct = {};
    std::optional<double> published_rhe_pct = {};
    // The effect of the fog in metres and m/s. The table shows it beside the percentages.
    metrics::FogEffect effect = {};
    metrics::FogEffect without = {};  // the effect without traded control
  };
  std::vector<Row> rows;
  std::string note;  // such as "mean and standard deviation over seeds 1 to 200"; "" if none
};

/// SI and RHE as functions of the threshold, over seeds.
struct ReportCurves {
  struct Point {
    double threshold = 0;
    stats::Summary si_pct;  // over the seeds that have SI
    stats::Summary rhe_pct;
  };
  std::string scenario_title;
  std::int64_t first_seed = 1;
  std::int64_t last_seed = 1;
  std::vector<Point> points;  // in ascending order of distinct thresholds
  std::vector<PublishedRow> published;
};

/// The whole page. It refers to no other file.
std::string MakeReport(std::span<const ReportRun> runs, const std::optional<ReportTable>& table,
                       const std::optional<ReportCurves>& curves = std::nullopt);

/// File format of a figure: pixels (PNG), or scalable lines (SVG, PDF).
enum class FigureFormat { kPng, kSvg, kPdf };

/// Draws one file for each figure with gnuplot, and adds the file to `files`. A figure has one
/// panel for each run, and all panels have the same axes. File names in the folder are
/// figure-1-speeds.png and so on.
/// @throws InputError if a file cannot be created in the folder; Interrupted; std::runtime_error
///     when the disk is full, or with gnuplot's own message if gnuplot fails or is not installed
void DrawFigures(const std::filesystem::path& dir, FigureFormat format,
                 std::span<const ReportRun> runs, AtomicFiles& files);

/// Draws the figures of the curves: figure-a-thresholds.png and figure-b-front.png.
/// @throws like DrawFigures()
void DrawCurveFigures(const std::filesystem::path& dir, FigureFormat format,
                      const ReportCurves& curves, AtomicFiles& files);

}  // namespace fogline::report
