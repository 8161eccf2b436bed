#include "services/runtime/realtime/deadline_rule.h"

#include <algorithm>

namespace fogline::runtime {

DeadlineRule::DeadlineRule(Parts& parts, const Scenario& scenario)
    : parts_(parts),
      watch_(parts, scenario),
      until_deadline_(duration_cast<Duration>(
          scenario.health.deadline_share *
          std::chrono::duration<double>(PeriodOf(scenario, parts.run.pace)))) {}

void DeadlineRule::OnInput(std::size_t input, std::int64_t step, Arrival& arrival) {
  watch_.Take(input, step, arrival);
}

TimePoint DeadlineRule::Poll(TimePoint now) {
  return watch_.Poll(now, [this](TimePoint time) { return Fire(time); });
}

TimePoint DeadlineRule::Fire(TimePoint now) {
  const auto inputs = parts_.inputs.all();
  const Input& tick = inputs[watch_.tick_input()];
  const std::int64_t step = tick.ring.newest();
  // After a pause, this process still decides the steps of the pause, so that the log has these
  // decisions.
  for (std::int64_t over = watch_.Oldest(step); over < step && parts_.own.Running(); ++over) {
    if (tick.ring.Has(over)) Decide(over, now);
  }
  if (step < parts_.steps.next() || !parts_.own.Running()) return now + OwnStatus::kHeartbeat;
  bool complete = true;
  TimePoint due = tick.heard;
  for (std::size_t i = 0; i < watch_.awaited().size(); ++i) {
    const bool there = inputs[i].ring.Has(step);
    // The role waits for a lost input only if messages of this input come again. Without this wait,
    // the role would decide before these messages come. The input would then be late in every step
    // and stay lost.
    if (!there && (watch_.StateOf(i) != InputState::kLost || watch_.Speaks(i, now)))
      complete = false;
    if (there) due = std::max(due, inputs[i].heard);
  }
  const TimePoint deadline = tick.heard + until_deadline_;
  if (!complete && now < deadline) return deadline;
  if (!complete) watch_.statistics().Miss();
  watch_.ComputeDue(step, complete ? due : deadline, now);
  return now + OwnStatus::kHeartbeat;
}

void DeadlineRule::Decide(std::int64_t step, TimePoint now) {
  const bool complete = std::ranges::all_of(
      watch_.awaited(), [step](const Input& input) { return input.ring.Has(step); });
  if (!complete) watch_.statistics().Miss();
  watch_.ComputeDue(step, parts_.inputs.all()[watch_.tick_input()].heard, now);
}

}  // namespace fogline::runtime
