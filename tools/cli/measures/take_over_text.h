// The measures of requests to take over, and of a person's inputs, as JSON and as text.
#pragma once

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "services/metrics/take_over/take_over_measures.h"
#include "tools/runner/experiment.h"

namespace fogline::cli {

/// {"outcome": "taken_over", "requested_s": 2.1, ...}; null for a measure without a value.
nlohmann::ordered_json TakeOverJson(const metrics::TakeOverMeasures& measures);

/// Adds "take_overs" and "input_latency" to the JSON object of a run. Without a request, and
/// without a person who drives, the object does not change.
void AddTakeOvers(const runner::ExperimentResult& result, nlohmann::ordered_json& json);

/// "taken over; reaction time 2.00 s; take-over time 2.10 s; ...": the outcome, and the measures
/// that have a value, without the time of the request.
std::string TakeOverLine(const metrics::TakeOverMeasures& measures);

/// The measures of a run as lines: a line for each request, lines "name value unit" for its
/// measures, and such lines for the latency of a person's inputs. "" if the run has neither a
/// request nor a person who drives.
std::string TakeOversText(const runner::ExperimentResult& result);

}  // namespace fogline::cli
