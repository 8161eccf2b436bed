#include "services/recorder/realtime_figures.h"

#include <algorithm>

#include "services/runtime/possible_status.h"

namespace fogline {

void RealtimeAccumulator::Add(const status_t& status) {
  if (!IsPossible(status)) return;  // a file may say anything
  status_t& last = last_[{status.role, status.instance}];
  if (status.sequence <= last.sequence) return;  // overtaken on its way
  last = status;
  fallbacks_.Add(status);
}

RealtimeFigures RealtimeAccumulator::Result() const {
  RealtimeFigures figures{.speed = speed_,
                          .missed_messages = missed_,
                          .fallbacks = fallbacks_.all(),
                          .fallbacks_left_out = fallbacks_.left_out()};
  for (const auto& [process, status] : last_) {
    if (process.first == NameOf(Role::kRecorder)) continue;  // nobody depends on it
    figures.deadline_misses += status.deadline_misses;
    for (const std::int64_t late : status.input_late) figures.late_messages += late;
    if (process.first != NameOf(Role::kWorld)) continue;
    figures.ticks += status.ticks;
    figures.ticks_late += status.ticks_late;
    figures.ticks_missed += status.ticks_missed;
    // Quantiles of two processes do not add: the worse one counts.
    figures.jitter_p99_us = std::max(figures.jitter_p99_us, status.jitter_p99_us);
    figures.latency_p50_us = std::max(figures.latency_p50_us, status.latency_p50_us);
    figures.latency_p99_us = std::max(figures.latency_p99_us, status.latency_p99_us);
    figures.latency_max_us = std::max(figures.latency_max_us, status.latency_max_us);
  }
  return figures;
}

}  // namespace fogline
