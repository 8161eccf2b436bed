#include "tools/report/curves.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/report/html.h"
#include "tools/report/tables.h"
#include "tools/stats/pareto.h"

namespace fogline::report {
namespace {

using nlohmann::json;

/// The thresholds of rows as text, such as "0.01–0.27, 0.3". Adjacent rows form a range.
std::string ThresholdsText(const ReportCurves& curves, const std::vector<std::size_t>& rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.size();) {
    const std::size_t first = i;
    do ++i;
    while (i < rows.size() && rows[i] == rows[i - 1] + 1);
    if (!text.empty()) text += ", ";
    text += fmt::format("{:g}", curves.points[rows[first]].threshold);
    if (i - first > 1) text += fmt::format("–{:g}", curves.points[rows[i - 1]].threshold);
  }
  return text;
}

bool IsTenth(double threshold) {
  constexpr double kRounding = 1e-9;
  return std::fabs(10 * threshold - std::round(10 * threshold)) < kRounding;
}

struct CurveFigure {
  std::string_view id;
  std::string_view letter;
  std::string_view title;
  std::string_view axis;
};

constexpr CurveFigure kThresholdFigure{"thresholds", "A",
                                       "Safety and engagement against the threshold",
                                       "Safety improvement (SI), redundant human engagement (RHE)"};
constexpr CurveFigure kFrontFigure{"front", "B", "The price of safety: the Pareto front",
                                   "Safety improvement (SI)"};

std::string CurveFigureElement(const CurveFigure& figure, const std::string& caption) {
  return FigureElement(
      figure.id, fmt::format("<span class=\"number\">{}</span> {}", figure.letter, figure.title),
      caption, fmt::format("{} <span class=\"unit\">%</span>", figure.axis));
}

/// A sentence with the number of seeds without SI; "" if all seeds have SI.
std::string MissingText(const ReportCurves& curves) {
  const auto least = std::ranges::min_element(
      curves.points, {}, [](const ReportCurves::Point& point) { return point.si_pct.count; });
  const std::int64_t seeds = curves.last_seed - curves.first_seed + 1;
  if (least == curves.points.end() || least->si_pct.count == seeds) return "";
  return fmt::format(
      " {} of the {} seeds have no SI: without traded control nothing is compromised there.",
      seeds - least->si_pct.count, seeds);
}

json ColumnOf(const ReportCurves& curves, stats::Summary ReportCurves::Point::*measure,
              std::optional<double> stats::Summary::*value) {
  json column = json::array();
  for (const ReportCurves::Point& point : curves.points) {
    const std::optional<double>& number = point.*measure.*value;
    column.push_back(number ? json(*number) : json(nullptr));
  }
  return column;
}

json ColumnsOf(const ReportCurves& curves, stats::Summary ReportCurves::Point::*measure) {
  return {{"mean", ColumnOf(curves, measure, &stats::Summary::mean)},
          {"deviation", ColumnOf(curves, measure, &stats::Summary::deviation)},
          {"ci95", ColumnOf(curves, measure, &stats::Summary::ci95)},
          {"p5", ColumnOf(curves, measure, &stats::Summary::p5)},
          {"p95", ColumnOf(curves, measure, &stats::Summary::p95)}};
}

}  // namespace

std::vector<FrontPoint> FrontPoints(const ReportCurves& curves) {
  std::vector<FrontPoint> points;
  for (std::size_t row = 0; row < curves.points.size(); ++row) {
    const std::optional<double>& rhe = curves.points[row].rhe_pct.mean;
    const std::optional<double>& si = curves.points[row].si_pct.mean;
    if (!rhe || !si) continue;
    const auto same = std::find_if(points.begin(), points.end(), [&](const FrontPoint& point) {
      return point.rhe_pct == *rhe && point.si_pct == *si;
    });
    if (same != points.end()) {
      same->rows.push_back(row);
    } else {
      points.push_back({.rhe_pct = *rhe, .si_pct = *si, .rows = {row}, .thresholds = ""});
    }
  }
  std::ranges::sort(points, {},
                    [](const FrontPoint& point) { return std::pair(point.rhe_pct, point.si_pct); });
  std::vector<stats::TradeOff> trade_offs;
  for (FrontPoint& point : points) {
    point.thresholds = ThresholdsText(curves, point.rows);
    trade_offs.push_back({.rhe_pct = point.rhe_pct, .si_pct = point.si_pct});
  }
  FrontPoint* before = nullptr;
  for (const std::size_t i : stats::ParetoFront(trade_offs)) {
    points[i].on_front = true;
    if (before != nullptr) {
      before->beside = points[i].si_pct - before->si_pct > points[i].rhe_pct - before->rhe_pct;
    }
    before = &points[i];
  }
  return points;
}

std::vector<std::size_t> LabelOrder(const ReportCurves& curves,
                                    std::span<const FrontPoint> points) {
  std::vector<std::size_t> tenths;
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool tenth =
        std::any_of(points[i].rows.begin(), points[i].rows.end(),
                    [&](std::size_t row) { return IsTenth(curves.points[row].threshold); });
    if (tenth) {
      tenths.push_back(i);
    } else if (points[i].on_front) {
      others.push_back(i);
    }
  }
  std::ranges::stable_sort(tenths, std::ranges::greater(),
                           [&](std::size_t i) { return points[i].rows.size(); });
  tenths.insert(tenths.end(), others.begin(), others.end());
  return tenths;
}

std::string SeedsText(const ReportCurves& curves) {
  return curves.first_seed == curves.last_seed
             ? fmt::format("seed {}", curves.first_seed)
             : fmt::format("seeds {} to {}", curves.first_seed, curves.last_seed);
}

std::string CurvesContent(const ReportCurves& curves) {
  const std::vector<FrontPoint> points = FrontPoints(curves);
  const std::string seeds = SeedsText(curves);
  const std::string about = fmt::format(
      "Lines: means over {}. Dark bands: 95 % confidence intervals of the means (Student’s t). "
      "Light bands: from the 5th to the 95th percentile of the seeds.{}",
      seeds, MissingText(curves));
  const std::string front = fmt::format(
      "A point is the mean over {} at one threshold; better is up and left. On the front, no "
      "other threshold gives more safety without more redundant engagement.",
      seeds);
  return fmt::format(
      "<p class=\"note hint\">Point at a figure for a threshold’s values, drag across it to look "
      "closer.</p>\n"
      "<div class=\"toolbar\" id=\"curve-tools\" hidden>\n"
      "<label class=\"time\"><span>Threshold</span><input type=\"range\" id=\"threshold\" "
      "min=\"0\" max=\"{}\" value=\"0\"><output id=\"threshold-text\" for=\"threshold\"></output>"
      "</label>\n<button type=\"button\" id=\"whole-curves\" disabled>Whole range</button>\n"
      "</div>\n<div class=\"figures\">\n{}{}</div>\n"
      "<details class=\"values\"><summary>All values</summary>\n{}</details>\n",
      curves.points.size() - 1, CurveFigureElement(kThresholdFigure, about),
      CurveFigureElement(kFrontFigure, front), CurveTable(curves, points));
}

std::string CurvesData(const ReportCurves& curves) {
  json thresholds = json::array();
  for (const ReportCurves::Point& point : curves.points) thresholds.push_back(point.threshold);
  const std::vector<FrontPoint> points = FrontPoints(curves);
  json places = json::array();
  for (const FrontPoint& point : points) {
    places.push_back({{"rhe", point.rhe_pct},
                      {"si", point.si_pct},
                      {"rows", point.rows},
                      {"thresholds", point.thresholds},
                      {"front", point.on_front},
                      {"beside", point.beside}});
  }
  json published = json::array();
  for (const PublishedRow& row : curves.published) {
    published.push_back({{"threshold", row.threshold}, {"si", row.si_pct}, {"rhe", row.rhe_pct}});
  }
  const json data{{"thresholds", std::move(thresholds)},
                  {"si", ColumnsOf(curves, &ReportCurves::Point::si_pct)},
                  {"rhe", ColumnsOf(curves, &ReportCurves::Point::rhe_pct)},
                  {"points", std::move(places)},
                  {"labels", LabelOrder(curves, points)},
                  {"published", std::move(published)}};
  return data.dump();
}

}  // namespace fogline::report
