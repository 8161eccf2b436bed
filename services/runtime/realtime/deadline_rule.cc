#include "services/runtime/realtime/deadline_rule.h"

#include <algorithm>

namespace fogline::runtime {

DeadlineRule::DeadlineRule(Node& node, const Scenario& scenario, double speed)
    : RealtimeRule(node, scenario, speed),
      until_deadline_(duration_cast<Duration>(scenario.health.deadline_share *
                                              std::chrono::duration<double>(period()))) {}

TimePoint DeadlineRule::Fire(TimePoint now) {
  const Input& tick = inputs()[tick_input()];
  const std::int64_t step = tick.ring.newest();
  // A process that was held up decides its old steps late, so that the log does not lack them.
  for (std::int64_t over = Oldest(step); over < step && Running(); ++over) {
    if (tick.ring.Has(over)) Decide(over, now);
  }
  if (step < next() || !Running()) return now + kHeartbeat;
  bool complete = true;
  TimePoint due = tick.heard;
  for (std::size_t i = 0; i < awaited().size(); ++i) {
    const bool there = inputs()[i].ring.Has(step);
    // The role does not wait for a lost input, but it waits for a lost input that comes again.
    // Without this wait it would decide before that input comes: the input would be late in every
    // step and stay lost.
    if (!there && (StateOf(i) != InputState::kLost || Speaks(i, now))) complete = false;
    if (there) due = std::max(due, inputs()[i].heard);
  }
  const TimePoint deadline = tick.heard + until_deadline_;
  if (!complete && now < deadline) return deadline;
  if (!complete) statistics().Miss();
  ComputeDue(step, complete ? due : deadline, now);
  return now + kHeartbeat;
}

void DeadlineRule::Decide(std::int64_t step, TimePoint now) {
  const bool complete =
      std::ranges::all_of(awaited(), [step](const Input& input) { return input.ring.Has(step); });
  if (!complete) statistics().Miss();
  ComputeDue(step, inputs()[tick_input()].heard, now);
}

}  // namespace fogline::runtime
