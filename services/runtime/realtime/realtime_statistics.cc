#include "services/runtime/realtime/realtime_statistics.h"

#include "fogline/status_t.hpp"

namespace fogline::runtime {
namespace {

constexpr double kMedian = 0.5;
constexpr double kTail = 0.99;

static_assert(static_cast<std::int8_t>(InputState::kAwaited) == status_t::INPUT_AWAITED);
static_assert(static_cast<std::int8_t>(InputState::kOk) == status_t::INPUT_OK);
static_assert(static_cast<std::int8_t>(InputState::kStale) == status_t::INPUT_STALE);
static_assert(static_cast<std::int8_t>(InputState::kLost) == status_t::INPUT_LOST);

std::int64_t Microseconds(Duration duration) {
  return duration_cast<std::chrono::microseconds>(duration).count();
}

}  // namespace

void RealtimeStatistics::Tick(TimePoint due, TimePoint now) {
  jitter_.Add(now < due ? due - now : now - due);
  if (now - due > kLate) ++ticks_late_;
}

void RealtimeStatistics::Write(status_t& status) const {
  status.ticks = ticks();
  status.ticks_late = ticks_late_;
  status.deadline_misses = deadline_misses_;
  status.jitter_p50_us = jitter_.QuantileUs(kMedian);
  status.jitter_p99_us = jitter_.QuantileUs(kTail);
  status.jitter_max_us = jitter_.MaxUs();
  status.latency_p50_us = latency_.QuantileUs(kMedian);
  status.latency_p99_us = latency_.QuantileUs(kTail);
  status.latency_max_us = latency_.MaxUs();
}

void ClearInputs(status_t& status) {
  status.num_inputs = 0;
  status.input.clear();
  status.input_state.clear();
  status.input_age_us.clear();
  status.input_rate_hz.clear();
  status.input_late.clear();
}

void WriteInput(std::string_view channel, const InputHealth& health, TimePoint now,
                status_t& status) {
  ++status.num_inputs;
  status.input.emplace_back(channel);
  status.input_state.push_back(static_cast<std::int8_t>(health.state()));
  status.input_age_us.push_back(Microseconds(health.Age(now)));
  status.input_rate_hz.push_back(health.RateHz(now));
  status.input_late.push_back(health.late());
}

}  // namespace fogline::runtime
