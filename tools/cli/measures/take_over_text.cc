#include "tools/cli/measures/take_over_text.h"

#include <cstddef>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/json.h"
#include "tools/report/metric_text.h"

namespace fogline::cli {
namespace {

/// Calls `visit(name, value, unit, description)` for each measure that has a value.
template <class Visitor>
void VisitValues(const metrics::TakeOverMeasures& measures, const Visitor& visit) {
  metrics::VisitTakeOver(measures, [&](std::string_view name, const std::optional<double>& value,
                                       std::string_view unit, std::string_view description) {
    if (value) visit(name, *value, unit, description);
  });
}

}  // namespace

nlohmann::ordered_json TakeOverJson(const metrics::TakeOverMeasures& measures) {
  nlohmann::ordered_json json{{"outcome", metrics::NameOf(measures.outcome)}};
  metrics::VisitTakeOver(
      measures, [&json](std::string_view name, const std::optional<double>& value, std::string_view,
                        std::string_view) { json[std::string(name)] = OrNull(value); });
  return json;
}

void AddTakeOvers(const runner::RunResult& result, nlohmann::ordered_json& json) {
  for (const metrics::TakeOverMeasures& measures : result.take_overs) {
    json["take_overs"].push_back(TakeOverJson(measures));
  }
  if (!result.input_latency) return;
  nlohmann::ordered_json& latency = json["input_latency"];
  log::VisitLatency(*result.input_latency,
                    [&latency](std::string_view name, std::int64_t value, std::string_view,
                               std::string_view) { latency[std::string(name)] = value; });
}

std::string TakeOverLine(const metrics::TakeOverMeasures& measures) {
  std::string line(report::OutcomeText(measures.outcome));
  VisitValues(measures, [&line](std::string_view name, double value, std::string_view unit,
                                std::string_view description) {
    if (name == "requested_s") return;
    line += fmt::format("; {} {} {}", description, report::MetricText(name, value, unit), unit);
  });
  return line;
}

std::string TakeOversText(const runner::RunResult& result) {
  std::string text;
  for (std::size_t i = 0; i < result.take_overs.size(); ++i) {
    const metrics::TakeOverMeasures& measures = result.take_overs[i];
    text += fmt::format("  take-over {}: {}\n", i + 1, report::OutcomeText(measures.outcome));
    VisitValues(measures, [&text](std::string_view name, double value, std::string_view unit,
                                  std::string_view) {
      text +=
          fmt::format("    {:<30}{:>12} {}\n", name, report::MetricText(name, value, unit), unit);
    });
  }
  if (!result.input_latency) return text;
  log::VisitLatency(*result.input_latency, [&text](std::string_view name, std::int64_t value,
                                                   std::string_view unit, std::string_view) {
    text += fmt::format("  {:<32}{:>12} {}\n", fmt::format("input_latency_{}", name), value, unit);
  });
  return text;
}

}  // namespace fogline::cli
