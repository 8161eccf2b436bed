// Figures A (SI and RHE over thresholds) and B (the Pareto front) as files for a paper.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "tools/report/curves.h"
#include "tools/report/figures.h"
#include "tools/report/plots/gnuplot.h"
#include "tools/report/report.h"
#include "tools/stats/statistics.h"

namespace fogline::report {
namespace {

constexpr std::string_view kSi = kPalette[0];
constexpr std::string_view kRhe = kPalette[1];
constexpr std::string_view kLight = "d8";  // transparency of the bands; ff is invisible
constexpr std::string_view kDark = "98";
constexpr double kHeight = 1000;              // in the unit of kWidth
constexpr double kLeastThresholdSpan = 0.01;  // gives a flat line a margin
constexpr double kLeastPercentSpan = 1;

std::string Number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "NaN"; }

/// "#rrggbb" as "#aarrggbb", the form of gnuplot.
std::string Transparent(std::string_view colour, std::string_view alpha) {
  return fmt::format("#{}{}", alpha, colour.substr(1));
}

/// Cells of a gnuplot data block: mean, ends of its 95 % confidence interval, 5th and 95th
/// percentile.
std::string Cells(const stats::Summary& of) {
  const double mean = of.mean.value_or(stats::kMissing);
  const double half = of.ci95.value_or(stats::kMissing);
  return fmt::format(" {} {} {} {} {}", Number(mean), Number(mean - half), Number(mean + half),
                     Number(of.p5.value_or(stats::kMissing)),
                     Number(of.p95.value_or(stats::kMissing)));
}

std::string CurvesBlock(const ReportCurves& curves) {
  std::string block = "$curves << EOD\n";
  for (const ReportCurves::Point& point : curves.points) {
    block += fmt::format("{}{}{}\n", point.threshold, Cells(point.si_pct), Cells(point.rhe_pct));
  }
  return block + "EOD\n";
}

/// A gnuplot data block with threshold, SI and RHE of the published rows.
std::string PublishedBlock(const ReportCurves& curves) {
  std::string block = "$published << EOD\n";
  for (const PublishedRow& row : curves.published) {
    block += fmt::format("{} {} {}\n", row.threshold, row.si_pct, row.rhe_pct);
  }
  if (curves.published.empty()) block += "NaN NaN NaN\n";  // gnuplot refuses an empty block
  return block + "EOD\n";
}

/// A gnuplot data block with RHE, SI, and 1 for a point on the front.
std::string PointsBlock(const std::vector<FrontPoint>& points) {
  std::string block = "$points << EOD\n";
  for (const FrontPoint& point : points) {
    block += fmt::format("{} {} {}\n", point.rhe_pct, point.si_pct, point.on_front ? 1 : 0);
  }
  if (points.empty()) block += "NaN NaN NaN\n";
  return block + "EOD\n";
}

/// Commands that write the thresholds below or beside their points. A label without room is
/// omitted.
std::string Labels(const ReportCurves& curves, const std::vector<FrontPoint>& points) {
  // Two labels differ by at least kWidePct in RHE, or by at least kHighPct in SI.
  constexpr double kWidePct = 9;
  constexpr double kHighPct = 4;
  std::vector<const FrontPoint*> labelled;
  std::string commands;
  for (const std::size_t i : LabelOrder(curves, points)) {
    const FrontPoint& point = points[i];
    const bool near = std::any_of(labelled.begin(), labelled.end(), [&](const FrontPoint* other) {
      return std::fabs(other->rhe_pct - point.rhe_pct) < kWidePct &&
             std::fabs(other->si_pct - point.si_pct) < kHighPct;
    });
    if (near) continue;
    labelled.push_back(&point);
    const bool is_right = point.rhe_pct > 90;
    commands += fmt::format(
        "set label {} at first {}, first {} {} offset {},{} front font ',15' textcolor rgb "
        "'#5b6670'\n",
        GnuplotString(point.thresholds), point.rhe_pct, point.si_pct, is_right ? "right" : "left",
        is_right ? -0.6 : 0.9, point.beside && !is_right ? 0.0 : -0.7);
  }
  return commands;
}

/// Parts of a plot command: the bands of a measure whose mean is in `column`. The light band is
/// from the 5th to the 95th percentile, the dark band is the confidence interval.
std::string Bands(int column, std::string_view colour) {
  return fmt::format(
      "$curves using 1:{}:{} with filledcurves fillcolor rgb '{}' fillstyle solid noborder "
      "notitle, \\\n     $curves using 1:{}:{} with filledcurves fillcolor rgb '{}' fillstyle "
      "solid noborder notitle",
      column + 3, column + 4, Transparent(colour, kLight), column + 1, column + 2,
      Transparent(colour, kDark));
}

std::string Diamonds(std::string_view columns, std::string_view colour) {
  return fmt::format(
      "$published using {} with points pointtype 12 pointsize 2.4*point_scale linewidth "
      "1.2/point_scale "
      "linecolor rgb '{}' "
      "notitle",
      columns, colour);
}

std::string CurveKey(const std::vector<std::string>& entries) {
  return fmt::format(
      "set key outside top center horizontal Left reverse samplen 2 width 1 font ',18' maxrows 2\n"
      "plot {}\n",
      fmt::join(entries, ", \\\n     "));
}

/// "set xrange" or "set yrange" for all `values` except NaN. The margin at each end is a share of
/// the range of the values, or of `least` if `least` is larger. So a flat line has a margin, too.
std::string Range(char axis, const std::vector<double>& values, double least) {
  constexpr double kMargin = 0.04;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) return fmt::format("set {}range [0:1]\n", axis);
  const double margin = kMargin * std::max(high - low, least);
  return fmt::format("set {}range [{}:{}]\n", axis, low - margin, high + margin);
}

std::string Axes(FigureFormat format, std::string_view x_name, std::string_view y_name) {
  constexpr Place kPlace{kRoomLeft / kWidth, 1 - kRoomRight / kWidth, kRoomBelow / kHeight,
                         1 - kRoomOfKey / kHeight};
  return Terminal(format, kHeight) + std::string(kAxes) + Margins(kPlace) +
         NameOfX(x_name, kHeight) + NameOfY(y_name, (kPlace.bottom + kPlace.top) / 2);
}

std::string ThresholdRanges(const ReportCurves& curves) {
  std::vector<double> thresholds;
  std::vector<double> values;
  for (const PublishedRow& row : curves.published) {
    thresholds.push_back(row.threshold);
    values.insert(values.end(), {row.si_pct, row.rhe_pct});
  }
  for (const ReportCurves::Point& point : curves.points) {
    thresholds.push_back(point.threshold);
    for (const stats::Summary& of : {point.si_pct, point.rhe_pct}) {
      values.insert(values.end(),
                    {of.mean.value_or(stats::kMissing), of.p5.value_or(stats::kMissing),
                     of.p95.value_or(stats::kMissing)});
    }
  }
  return Range('x', thresholds, kLeastThresholdSpan) + Range('y', values, kLeastPercentSpan);
}

std::string FrontRanges(const ReportCurves& curves, const std::vector<FrontPoint>& points) {
  std::vector<double> rhe;
  std::vector<double> si;
  for (const PublishedRow& row : curves.published) {
    rhe.push_back(row.rhe_pct);
    si.push_back(row.si_pct);
  }
  for (const FrontPoint& point : points) {
    rhe.push_back(point.rhe_pct);
    si.push_back(point.si_pct);
  }
  return Range('x', rhe, kLeastPercentSpan) + Range('y', si, kLeastPercentSpan);
}

std::string ThresholdScript(FigureFormat format, const ReportCurves& curves) {
  constexpr int kSiColumn = 2;
  constexpr int kRheColumn = 7;
  return CurvesBlock(curves) + PublishedBlock(curves) +
         Axes(format, "DoC threshold", "SI, RHE (%)") + ThresholdRanges(curves) +
         CurveKey(
             {Bands(kSiColumn, kSi), Bands(kRheColumn, kRhe),
              fmt::format("$curves using 1:{} with lines linewidth 1.5 linecolor rgb '{}' title "
                          "'safety improvement (SI)'",
                          kSiColumn, kSi),
              fmt::format("$curves using 1:{} with lines linewidth 1.5 dashtype (8, 4) linecolor "
                          "rgb '{}' title 'redundant engagement (RHE)'",
                          kRheColumn, kRhe),
              Diamonds("1:2", kSi), Diamonds("1:3", kRhe),
              fmt::format("keyentry with boxes fillcolor rgb '{}' fillstyle solid noborder title "
                          "'95 % CI of the mean'",
                          Transparent(kSi, kDark)),
              fmt::format("keyentry with boxes fillcolor rgb '{}' fillstyle solid noborder title "
                          "'5th to 95th percentile of seeds'",
                          Transparent(kSi, kLight)),
              "keyentry with points pointtype 12 pointsize 2*point_scale "
              "linecolor rgb 'black' "
              "title "
              "'published'"});
}

std::string FrontScript(FigureFormat format, const ReportCurves& curves) {
  const std::vector<FrontPoint> points = FrontPoints(curves);
  return PointsBlock(points) + PublishedBlock(curves) + Labels(curves, points) +
         Axes(format, "Redundant human engagement (RHE, %)", "Safety improvement (SI, %)") +
         FrontRanges(curves, points) +
         CurveKey(
             {"$points using ($3 == 0 ? $1 : NaN):2 with points pointtype 6 pointsize "
              "1.2*point_scale "
              "linecolor "
              "rgb '#6b757f' title 'another threshold is better'",
              fmt::format(
                  "$points using ($3 == 1 ? $1 : NaN):2 with linespoints pointtype 7 "
                  "pointsize 1.4*point_scale linewidth 1.2 linecolor rgb '{}' title 'Pareto front'",
                  kSi),
              Diamonds("3:2", kInk),
              fmt::format("keyentry with points pointtype 12 pointsize 2*point_scale linewidth "
                          "1/point_scale linecolor rgb "
                          "'{}' title "
                          "'published'",
                          kInk)});
}

}  // namespace

void DrawCurveFigures(const std::filesystem::path& dir, FigureFormat format,
                      const ReportCurves& curves, AtomicFiles& files) {
  RunGnuplot(ThresholdScript(format, curves), files.Add(dir / FigureFile(format, "a-thresholds")));
  RunGnuplot(FrontScript(format, curves), files.Add(dir / FigureFile(format, "b-front")));
}

}  // namespace fogline::report
