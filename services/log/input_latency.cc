#include "services/log/input_latency.h"

#include <chrono>
#include <utility>

namespace fogline::log {

void InputLatencyAccumulator::Add(const driver_input_t& input) {
  if (input.latency_us < 0) return;
  const std::pair measurement(input.time_us, input.latency_us);
  const auto [newest, is_first] = newest_.try_emplace(input.instance, measurement);
  if (!is_first && std::exchange(newest->second, measurement) == measurement) return;
  latencies_.Add(std::chrono::microseconds(input.latency_us));
}

InputLatency InputLatencyAccumulator::Result() const {
  return {.inputs = latencies_.count(),
          .p50_us = latencies_.QuantileUs(0.5),
          .p95_us = latencies_.QuantileUs(0.95),
          .max_us = latencies_.MaxUs()};
}

}  // namespace fogline::log
