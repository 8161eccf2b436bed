#include "services/log/realtime_figures.h"

#include <algorithm>

#include "services/runtime/lockstep/possible_status.h"

namespace fogline::log {

void RealtimeAccumulator::Add(const status_t& status) {
  if (!runtime::IsPossible(status)) return;  // a file may contain any numbers
  status_t& last = last_[{status.role, status.instance}];
  if (status.sequence <= last.sequence) return;  // a newer STATUS came earlier
  last = status;
  fallbacks_.Add(status);
}

void RealtimeAccumulator::AddStep(const runtime::ChannelSet& there) {
  ++steps_;
  if (logged_[IndexOf<truth_t>()] == 0 && !there[IndexOf<truth_t>()]) ++late_steps_;
  for (std::size_t i = 0; i < kNumChannels; ++i) logged_[i] += there[i] ? 1 : 0;
}

std::int64_t RealtimeAccumulator::Unlogged(std::size_t channel) const {
  const Role from = kChannels[channel].from;
  // The world skips no step, even if several processes of the world compute the steps.
  if (from == Role::kWorld) return steps_ - logged_[channel];
  std::int64_t published = 0;
  int processes = 0;
  std::int64_t late = 0;  // messages that came after the recorder had written their step
  for (const auto& [process, status] : last_) {
    if (process.first == NameOf(from)) {
      published = status.ticks;
      ++processes;
    }
    if (process.first != NameOf(Role::kRecorder)) continue;
    const auto input = std::ranges::find(status.input, kChannels[channel].name);
    if (input != status.input.end()) {
      late += status.input_late[static_cast<std::size_t>(input - status.input.begin())];
    }
  }
  // With several processes the number of published messages is not known, because a restarted
  // process may compute a step a second time.
  return processes == 1 ? std::max<std::int64_t>(0, published - logged_[channel] - late) : 0;
}

bool RealtimeAccumulator::HasStatus(Role role) const {
  return std::ranges::any_of(
      last_, [role](const auto& status) { return status.first.first == NameOf(role); });
}

RealtimeFigures RealtimeAccumulator::Result() const {
  RealtimeFigures figures{.speed = speed_,
                          .fallbacks = fallbacks_.all(),
                          .fallbacks_left_out = fallbacks_.left_out(),
                          .priority = priority_};
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    if (kChannels[i].pace != Pace::kStep) continue;
    figures.missed_messages += steps_ - logged_[i];
    const std::int64_t unlogged = Unlogged(i);
    figures.unlogged_messages += unlogged;
    const std::int64_t missed = steps_ - late_steps_ - logged_[i];
    figures.unlogged_channels[i] =
        HasStatus(kChannels[i].from) ? unlogged > late_steps_ : missed > 0;
  }
  for (const auto& [process, status] : last_) {
    if (process.first == NameOf(Role::kRecorder)) continue;  // no role waits for the recorder
    figures.deadline_misses += status.deadline_misses;
    for (const std::int64_t late : status.input_late) figures.late_messages += late;
    if (process.first != NameOf(Role::kWorld)) continue;
    figures.has_status = true;
    figures.ticks += status.ticks;
    figures.ticks_late += status.ticks_late;
    figures.ticks_missed += status.ticks_missed;
    // Quantiles of several processes cannot be added, so the largest quantile counts.
    figures.jitter_p99_us = std::max(figures.jitter_p99_us, status.jitter_p99_us);
    figures.latency_p50_us = std::max(figures.latency_p50_us, status.latency_p50_us);
    figures.latency_p99_us = std::max(figures.latency_p99_us, status.latency_p99_us);
    figures.latency_max_us = std::max(figures.latency_max_us, status.latency_max_us);
  }
  return figures;
}

}  // namespace fogline::log
