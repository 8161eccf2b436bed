#include "tools/report/page_data.h"

#include <cmath>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/report/curves.h"
#include "tools/report/figures.h"
#include "tools/report/tables.h"

namespace fogline::report {
namespace {

using nlohmann::json;

std::string Dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Rounds to six decimals (a micrometre for a length). So the text has a third of the bytes that it
/// would have without rounding. A value of 1e9 or more is not rounded: its text is hardly longer
/// than with six decimals.
double Rounded(double value) {
  constexpr double kGrid = 1e6;
  constexpr double kLargest = 1e9;
  if (!(std::fabs(value) < kLargest)) return value;
  return std::round(value * kGrid) / kGrid + 0.0;  // + 0.0 changes -0.0 into 0.0
}

/// Columns as JSON texts. A text that occurs several times is stored only once.
class ColumnPool {
 public:
  std::size_t Place(const std::vector<double>& values) {
    json column = json::array();
    for (const double value : values) column.push_back(Rounded(value));
    const auto [entry, is_new] = places_.emplace(Dump(column), texts_.size());
    if (is_new) texts_.push_back(entry->first);
    return entry->second;
  }

  std::string Json() const {
    std::string text = "[";
    for (const std::string_view column : texts_) {
      if (text.size() > 1) text += ",\n";
      text += column;
    }
    return text + "]";
  }

 private:
  std::map<std::string, std::size_t> places_;
  std::vector<std::string_view> texts_;  // views of the keys of places_
};

std::string_view HoldText(Hold hold) {
  switch (hold) {
    case Hold::kLinear:
      return "linear";
    case Hold::kSince:
      return "since";
    case Hold::kUntil:
      return "until";
  }
  return "";
}

/// Lengths of dashes and gaps in pixels.
json LengthsOf(Dash dash) {
  switch (dash) {
    case Dash::kSolid:
      return json::array();
    case Dash::kDashed:
      return {6, 4};
    case Dash::kDotted:
      return {2, 3};
    case Dash::kDashDot:
      return {7, 3, 2, 3};
    case Dash::kLong:
      return {11, 4};
  }
  return json::array();
}

json CurveJson(const Curve& curve) {
  return {{"column", curve.column},
          {"label", curve.label},
          {"hold", HoldText(curve.hold)},
          {"colour", curve.colour},
          {"dash", LengthsOf(curve.dash)},
          {"detail", curve.part == Part::kDetail},
          {"limit", curve.part == Part::kLimit}};
}

json ShadeJson(const Shade& shade) {
  if (shade.below.empty()) return nullptr;
  return {{"below", shade.below}, {"limit", shade.limit}, {"meaning", shade.meaning}};
}

json FigureJson(const Figure& figure) {
  json curves = json::array();
  for (const Curve& curve : figure.curves) curves.push_back(CurveJson(curve));
  return {{"id", figure.id},
          {"title", figure.title},
          {"unit", figure.unit},
          {"decimals", figure.decimals},
          {"leastSpan", figure.least_span},
          {"shade", ShadeJson(figure.shade)},
          {"strips", figure.strips},
          {"curves", std::move(curves)}};
}

json WindowsJson(const std::vector<Window>& windows) {
  json spans = json::array();
  for (const Window& window : windows) {
    spans.push_back({Rounded(window.begin_s), Rounded(window.end_s)});
  }
  return spans;
}

}  // namespace

std::string PageData(std::span<const ReportRun> runs, const std::optional<ReportCurves>& curves) {
  json figures = json::array();
  for (const Figure& figure : Figures()) figures.push_back(FigureJson(figure));
  ColumnPool pool;
  json run_list = json::array();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::vector<metrics::Sample>& samples = runs[i].samples;
    json columns = json::object();
    for (const Column& column : kColumns) {
      columns[std::string(column.name)] = pool.Place(Values(column, samples));
    }
    run_list.push_back({{"name", RunName(runs, i)},
                        {"badge", BadgeOf(runs[i])},
                        {"columns", std::move(columns)},
                        {"fog", WindowsJson(FogWindows(samples))},
                        {"human", WindowsJson(HumanWindows(samples))}});
  }
  return "{\"figures\":" + Dump(figures) + ",\n\"columns\":" + pool.Json() +
         ",\n\"runs\":" + Dump(run_list) +
         ",\n\"curves\":" + (curves ? CurvesData(*curves) : "null") + "}";
}

}  // namespace fogline::report
