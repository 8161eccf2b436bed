#include "services/log/realtime_figures.h"

#include <algorithm>

#include "services/runtime/lockstep/possible_status.h"

namespace fogline::log {
namespace {

// The number of newest steps that are kept. Check() counts the messages up to the step that a
// STATUS names. If the STATUS comes late in the log, later steps were already added. Check() needs
// these later steps to subtract their messages. A role that computes no step names the same step
// in its STATUS for a long time. If more than kKeptSteps steps follow this step, the number of the
// role's lost messages is only a lower bound.
constexpr std::size_t kKeptSteps = 1024;

}  // namespace

void RealtimeAccumulator::Add(const status_t& status) {
  if (!runtime::IsPossible(status)) return;  // a file may contain any numbers
  Process& process = last_[{status.role, status.instance}];
  if (status.sequence <= process.status.sequence) return;  // a newer STATUS came earlier
  process.status = status;
  process.is_checked = false;
  if (status.header.step < steps_) {
    Check(process);
  } else {
    due_.emplace(status.header.step, &process);
  }
  fallbacks_.Add(status);
}

void RealtimeAccumulator::AddStep(const runtime::ChannelSet& there) {
  const std::int64_t step = steps_++;
  const bool is_late = logged_[IndexOf<truth_t>()] == 0 && !there[IndexOf<truth_t>()];
  if (is_late) ++late_steps_;
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    logged_[i] += there[i] ? 1 : 0;
    if (!there[i] && !is_late) ++unchecked_[i];
  }
  kept_.push_back(there);
  if (kept_.size() > kKeptSteps) kept_.pop_front();
  const auto end = due_.upper_bound(step);
  for (auto due = due_.begin(); due != end; ++due) {
    if (due->second->status.header.step == step) Check(*due->second);
  }
  due_.erase(due_.begin(), end);
}

// Called after AddStep() for the step of the STATUS. `after` is the number of later steps that were
// also added.
void RealtimeAccumulator::Check(Process& process) {
  process.is_checked = true;
  const std::int64_t after = steps_ - 1 - process.status.header.step;
  const bool is_kept = after <= std::ssize(kept_);
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    if (process.status.role != NameOf(kChannels[i].from)) continue;
    process.unlogged[i] = process.status.ticks - logged_[i];
    if (!is_kept) continue;
    const std::int64_t there = std::count_if(kept_.end() - after, kept_.end(),
                                             [i](const auto& channels) { return channels[i]; });
    process.unlogged[i] += there;
    unchecked_[i] = after - there;
  }
}

std::int64_t RealtimeAccumulator::Unlogged(std::size_t channel) const {
  const Role from = kChannels[channel].from;
  // The world skips no step, even if several processes of the world compute the steps. So the world
  // has published a message for each step.
  if (from == Role::kWorld) return steps_ - logged_[channel];
  std::int64_t unlogged = 0;
  int processes = 0;
  std::int64_t late = 0;  // messages that came after the recorder had written their step
  for (const auto& [name, process] : last_) {
    const status_t& status = process.status;
    if (name.first == NameOf(from)) {
      unlogged = process.is_checked ? process.unlogged[channel] : status.ticks - logged_[channel];
      ++processes;
    }
    if (name.first != NameOf(Role::kRecorder)) continue;
    const auto input = std::ranges::find(status.input, kChannels[channel].name);
    if (input != status.input.end()) {
      late += status.input_late[static_cast<std::size_t>(input - status.input.begin())];
    }
  }
  // With several processes the number of published messages is not known, because a restarted
  // process may compute a step a second time. The result is then 0.
  return processes == 1 ? std::max<std::int64_t>(0, unlogged - late) : 0;
}

bool RealtimeAccumulator::MayLack(std::size_t channel, bool has_all) const {
  const Role from = kChannels[channel].from;
  const std::int64_t missed = steps_ - late_steps_ - logged_[channel];
  if (!HasStatus(from)) return missed > 0;
  if (has_all || from == Role::kWorld) return false;
  const auto processes = std::ranges::count_if(
      last_, [from](const auto& process) { return process.first.first == NameOf(from); });
  return processes > 1 ? missed > 0 : unchecked_[channel] > 0;
}

bool RealtimeAccumulator::HasStatus(Role role) const {
  return std::ranges::any_of(
      last_, [role](const auto& status) { return status.first.first == NameOf(role); });
}

RealtimeFigures RealtimeAccumulator::Result(bool has_all) const {
  RealtimeFigures figures{.speed = speed_,
                          .fallbacks = fallbacks_.all(),
                          .fallbacks_left_out = fallbacks_.left_out(),
                          .priority = priority_};
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    if (kChannels[i].pace != Pace::kStep) continue;
    figures.missed_messages += steps_ - logged_[i];
    const std::int64_t unlogged = Unlogged(i);
    figures.unlogged_messages += unlogged;
    figures.unlogged_channels[i] = MayLack(i, has_all) || unlogged > late_steps_;
  }
  for (const auto& [name, process] : last_) {
    const status_t& status = process.status;
    if (name.first == NameOf(Role::kRecorder)) continue;  // no role waits for the recorder
    figures.deadline_misses += status.deadline_misses;
    for (const std::int64_t late : status.input_late) figures.late_messages += late;
    if (name.first != NameOf(Role::kWorld)) continue;
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
