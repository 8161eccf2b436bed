#include "services/runtime/realtime/realtime_rule.h"

#include <algorithm>
#include <span>

namespace fogline::runtime {

void RealtimeRule::OnInput(std::size_t input, std::int64_t step, Arrival& arrival) {
  watch_.Take(input, step, arrival);
}

TimePoint RealtimeRule::Poll(TimePoint now) {
  return watch_.Poll(now, [this](TimePoint time) { return Fire(time); });
}

TimePoint RealtimeRule::Fire(TimePoint now) {
  const std::span<const Input> needed = watch_.awaited();
  std::int64_t newest = needed.front().ring.newest();
  for (const Input& input : needed) newest = std::min(newest, input.ring.newest());
  for (std::int64_t step = watch_.Oldest(newest); step <= newest && parts_.own.Running(); ++step) {
    const bool all =
        std::ranges::all_of(needed, [step](const Input& input) { return input.ring.Has(step); });
    if (!all) continue;
    const TimePoint due = std::ranges::max_element(needed, {}, &Input::heard)->heard;
    watch_.ComputeDue(step, due, now);
  }
  return now + OwnStatus::kHeartbeat;
}

}  // namespace fogline::runtime
