// The measures of requests to take over, and of a person's inputs, as JSON and as text.
#pragma once

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "services/metrics/take_over/take_over_measures.h"
#include "tools/runner/scenario_run.h"

namespace fogline::cli {

/// The measures of one request: {"outcome": "taken_over", "requested_s": 2.1, ...}. null stands for
/// a measure without a value.
nlohmann::ordered_json TakeOverJson(const metrics::TakeOverMeasures& measures);

/// Adds "take_overs" and "input_latency" to the JSON object of a run. The object does not change if
/// the run has neither a request nor a person who drives.
void AddTakeOvers(const runner::RunResult& result, nlohmann::ordered_json& json);

/// The outcome of a request and the measures that have a value, without the time of the request:
/// "taken over; reaction time 2.00 s; take-over time 2.10 s; ...".
std::string TakeOverLine(const metrics::TakeOverMeasures& measures);

/// The measures of a run as lines: a line for each request, lines "name value unit" for its
/// measures, and such lines for the latency of a person's inputs. "" if the run has neither a
/// request nor a person who drives.
std::string TakeOversText(const runner::RunResult& result);

}  // namespace fogline::cli
