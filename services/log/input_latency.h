// The time from a person's input to the frame that shows this input, over a whole run.
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include "services/graph.h"
#include "services/runtime/realtime/duration_histogram.h"

namespace fogline::log {

struct InputLatency {
  std::int64_t inputs = 0;  // inputs with a measurement
  // Quantiles and the largest time. A quantile is too large by at most 1.6 % (DurationHistogram).
  std::int64_t p50_us = 0;
  std::int64_t p95_us = 0;
  std::int64_t max_us = 0;
};

/// Calls `visit(name, value, unit, description)` for every number, in order.
template <class Visitor>
void VisitLatency(const InputLatency& l, Visitor&& visit) {
  visit("inputs", l.inputs, "", "inputs with a measured latency");
  visit("p50_us", l.p50_us, "us", "from an input to the frame that shows it: median");
  visit("p95_us", l.p95_us, "us", "the same: 95 % are below");
  visit("max_us", l.max_us, "us", "the same: longest");
}

/// Collects the latencies of a run. A seat sends each measurement once. A message that repeats the
/// seat's previous measurement, with the same driver_input_t.time_us, does not count.
class InputLatencyAccumulator {
 public:
  /// Adds the next DRIVER_INPUT of the log.
  void Add(const driver_input_t& input);
  InputLatency Result() const;

 private:
  runtime::DurationHistogram latencies_;
  // time_us and latency_us of the last measurement of each seat, by driver_input_t.instance.
  std::map<std::int64_t, std::pair<std::int64_t, std::int64_t>> newest_;
};

}  // namespace fogline::log
