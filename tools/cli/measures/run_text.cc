#include "tools/cli/measures/run_text.h"

#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/json.h"
#include "tools/report/metric_text.h"

namespace fogline::cli {
namespace {

/// Returns a visitor that puts every measure into a JSON object.
auto Into(nlohmann::ordered_json& json) {
  return
      [&json]<class V>(std::string_view name, const V& value, std::string_view, std::string_view) {
        if constexpr (std::is_same_v<V, std::optional<double>>) {
          json[std::string(name)] = OrNull(value);
        } else {
          json[std::string(name)] = value;
        }
      };
}

std::string Cell(std::string_view name, std::optional<double> value, std::string_view unit) {
  return value ? report::MetricText(name, *value, unit) : "-";
}

/// A table: a line of column names, then one line for each following car.
std::string FollowersText(const std::vector<metrics::FollowerMetrics>& followers) {
  std::string text = fmt::format("  {:<10}", "follower");
  metrics::VisitFollowerMetrics(metrics::FollowerMetrics(),
                                [&text](std::string_view name, const auto&, std::string_view,
                                        std::string_view) { text += fmt::format("  {}", name); });
  text += '\n';
  for (std::size_t i = 0; i < followers.size(); ++i) {
    text += fmt::format("  {:<10}", i + 1);
    metrics::VisitFollowerMetrics(followers[i], [&text](std::string_view name, const auto& value,
                                                        std::string_view unit, std::string_view) {
      text += fmt::format("  {:>{}}", Cell(name, value, unit), name.size());
    });
    text += '\n';
  }
  return text;
}

}  // namespace

std::string MetricsJson(const runner::RunResult& result) {
  nlohmann::ordered_json json;
  metrics::VisitMetrics(result.measures, Into(json));
  for (auto& [name, value] : json.items()) {
    if (!metrics::IsKnown(name, !value.is_null(), result.lack)) value = nullptr;
  }
  if (result.followers.size() > 1) {
    for (const metrics::FollowerMetrics& follower : result.followers) {
      metrics::VisitFollowerMetrics(follower, Into(json["followers"].emplace_back()));
    }
  }
  return json.dump();
}

std::string MetricsText(const runner::RunResult& result) {
  std::string text;
  metrics::VisitMetrics(result.measures, [&]<class V>(std::string_view name, const V& value,
                                                      std::string_view unit, std::string_view) {
    if (!metrics::IsKnown(name, value, result.lack)) {
      text += fmt::format("  {:<32}{:>12}\n", name, "unknown");
    } else if constexpr (std::is_same_v<V, std::optional<double>>) {
      text += fmt::format("  {:<32}{:>12} {}\n", name, Cell(name, value, unit), unit);
    } else {
      text += fmt::format("  {:<32}{:>12} {}\n", name, value, unit);
    }
  });
  return result.followers.size() > 1 ? text + FollowersText(result.followers) : text;
}

nlohmann::ordered_json RealtimeJson(const log::RealtimeFigures& figures) {
  nlohmann::ordered_json json;
  log::VisitFigures(figures, [&](std::string_view name, const auto& value, std::string_view,
                                 std::string_view) {
    json[std::string(name)] = log::IsKnown(name, figures) ? nlohmann::ordered_json(value) : nullptr;
  });
  json["fallbacks"] = nlohmann::ordered_json::array();
  for (const runtime::Fallback& fallback : figures.fallbacks) {
    nlohmann::ordered_json entry{
        {"step", fallback.step}, {"role", fallback.role}, {"what", fallback.what}};
    entry["culprit"] = nullptr;
    if (!fallback.culprit.empty()) entry["culprit"] = fallback.culprit;
    json["fallbacks"].push_back(std::move(entry));
  }
  json["fallbacks_left_out"] = figures.fallbacks_left_out;
  if (figures.priority) {
    json["priority"] = {{"granted", figures.priority->granted},
                        {"refused", figures.priority->refused},
                        {"unknown", figures.priority->unknown}};
  }
  return json;
}

std::string PriorityText(const log::RealtimePriority& priority) {
  std::string text;
  const auto add = [&text](const char* what, const std::vector<std::string>& roles) {
    if (!roles.empty()) text += fmt::format("  {}: {}\n", what, fmt::join(roles, ", "));
  };
  add("with real-time priority", priority.granted);
  add("without real-time priority", priority.refused);
  add("on other machines, real-time priority unknown", priority.unknown);
  return text;
}

std::string RealtimeText(const log::RealtimeFigures& figures) {
  std::string text;
  log::VisitFigures(figures, [&](std::string_view name, const auto& value, std::string_view unit,
                                 std::string_view) {
    const bool known = log::IsKnown(name, figures);
    text += known ? fmt::format("  {:<32}{:>12} {}\n", name, value, unit)
                  : fmt::format("  {:<32}{:>12}\n", name, "unknown");
  });
  if (figures.priority) text += PriorityText(*figures.priority);
  for (const runtime::Fallback& fallback : figures.fallbacks) {
    text += fmt::format("  {}\n", fallback.Text());
  }
  if (figures.fallbacks_left_out > 0) {
    text += fmt::format("  ... and {} more\n", figures.fallbacks_left_out);
  }
  return text;
}

}  // namespace fogline::cli
