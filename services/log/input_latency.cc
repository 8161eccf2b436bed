#include "services/log/input_latency.h"

#include <chrono>

namespace fogline::log {

void InputLatencyAccumulator::Add(const driver_input_t& input) {
  const auto [newest, is_first] = newest_us_.try_emplace(input.instance, input.time_us);
  if (!is_first && newest->second == input.time_us) return;
  newest->second = input.time_us;
  if (input.latency_us >= 0) latencies_.Add(std::chrono::microseconds(input.latency_us));
}

InputLatency InputLatencyAccumulator::Result() const {
  return {.inputs = latencies_.count(),
          .p50_us = latencies_.QuantileUs(0.5),
          .p95_us = latencies_.QuantileUs(0.95),
          .max_us = latencies_.MaxUs()};
}

}  // namespace fogline::log
