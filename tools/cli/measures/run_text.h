// The measures of a run, and its figures in real time, as text and as JSON.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tools/runner/scenario_run.h"

namespace fogline::cli {

/// The measures of a run as a JSON object {"name": value, ...}, to be put into a larger JSON text.
/// With more than one following car, "followers" is the list of their measures.
std::string MetricsJson(const runner::RunResult& result);

/// The measures of a run as lines "name  value unit". If there is more than one following car, a
/// table of their measures follows.
std::string MetricsText(const runner::RunResult& result);

/// The figures of a run in real time, and its fallbacks, as JSON and as text.
nlohmann::ordered_json RealtimeJson(const log::RealtimeFigures& figures);
std::string RealtimeText(const log::RealtimeFigures& figures);
/// A line for each list of roles that is not empty, such as "  with real-time priority: world,
/// radar".
std::string PriorityText(const log::RealtimePriority& priority);

}  // namespace fogline::cli
