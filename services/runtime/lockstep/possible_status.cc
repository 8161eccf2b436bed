#include "services/runtime/lockstep/possible_status.h"

#include <algorithm>
#include <cstdint>

#include "services/runtime/wire/refusals.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::runtime {
namespace {

// The largest simulated time of a run. A step lasts one second at most (scenario field step_s).
constexpr std::int64_t kMaxTime_us = kMaxStep * 1'000'000;

// The counters that Fogline adds up or compares. The counters of refusals are in kRefusals.
constexpr std::int64_t status_t::*kCounters[] = {
    &status_t::last_heard_ms,  &status_t::repairs_asked,   &status_t::repairs_served,
    &status_t::duplicates,     &status_t::ticks,           &status_t::ticks_late,
    &status_t::ticks_missed,   &status_t::deadline_misses, &status_t::jitter_p50_us,
    &status_t::jitter_p99_us,  &status_t::jitter_max_us,   &status_t::latency_p50_us,
    &status_t::latency_p99_us, &status_t::latency_max_us,  &status_t::log_begin,
    &status_t::log_bytes,      &status_t::sends_failed,
};

bool Counted(std::int64_t number) { return number >= 0 && number <= kMaxStep; }

}  // namespace

bool IsPossible(const status_t& status) {
  return status.header.step >= -1 && status.header.step <= kMaxStep && Counted(status.sequence) &&
         status.header.utime >= -kMaxTime_us && status.header.utime <= kMaxTime_us &&
         std::ranges::all_of(kCounters, [&](auto counter) { return Counted(status.*counter); }) &&
         std::ranges::all_of(
             kRefusals, [&](const RefusalKind& kind) { return Counted(status.*kind.counter); }) &&
         std::ranges::all_of(status.input_late, Counted);
}

}  // namespace fogline::runtime
