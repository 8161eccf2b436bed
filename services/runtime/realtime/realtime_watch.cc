#include "services/runtime/realtime/realtime_watch.h"

#include <cmath>

#include "services/runtime/realtime/culprit.h"

namespace fogline::runtime {
namespace {

// The share of a period by which a call of Poll() may be late. A later call means that this process
// was paused. RunClock has the same limit for the world's ticks.
constexpr double kLateCall = 0.25;
// Speaks() is true if the newest message of the input is at most this many periods old. By default
// this limit is below lost_periods, the number of periods without a new step after which an input
// is LOST.
constexpr int kSpeaks = 2;

/// Index of the first input from the world. Its messages are the world's ticks, which begin the
/// steps of the role. The result is the number of inputs if the role reads no input from the world.
std::size_t TickInputOf(std::span<const Input> inputs) {
  const auto tick = std::ranges::find(
      inputs, Role::kWorld, [](const Input& input) { return kChannels[input.channel].from; });
  return static_cast<std::size_t>(tick - inputs.begin());
}

}  // namespace

Duration PeriodOf(const Scenario& scenario, double speed) {
  return duration_cast<Duration>(std::chrono::duration<double>(scenario.step_s / speed));
}

RealtimeWatch::RealtimeWatch(Parts& parts, const Scenario& scenario)
    : parts_(parts),
      period_(PeriodOf(scenario, parts.run.pace)),
      step_us_(std::llround(scenario.step_s * kMicrosPerSecond)),
      limits_(scenario.health),
      clock_(period_, Clock::now()),
      horizon_(period_),
      tick_input_(TickInputOf(parts.inputs.all())),
      late_(parts.inputs.all().size()) {
  const TimePoint began = clock_.At(Clock::now());
  const auto judged = std::ranges::count(parts_.inputs.all(), false, &Input::on_demand);
  health_.assign(static_cast<std::size_t>(judged), InputHealth(limits_, period_, began));
  OnProgress();
}

StepRing::Verdict RealtimeWatch::Judge(std::size_t input, std::int64_t step, Bytes bytes) {
  const Input& from = parts_.inputs.all()[input];
  const StepRing& ring = from.ring;
  if (ring.Has(step) && std::ranges::equal(ring.Get(step), bytes)) {
    return StepRing::Verdict::kDuplicate;
  }
  // An input on demand is a channel that the role reads only in some scenarios. A message of such
  // an input is late only if a message of the same step or of a later step has come before.
  const bool late = from.on_demand ? step <= ring.newest()
                                   : step < parts_.steps.next() - from.lag ||
                                         step <= ring.newest() - kRingSteps || ring.Has(step);
  const TimePoint now = Clock::now();
  if (late) {
    ++late_[input].count;
    late_[input].at = now;
    return StepRing::Verdict::kLate;
  }
  return step <= NewestPossible(now) ? StepRing::Verdict::kNew : StepRing::Verdict::kOutOfWindow;
}

void RealtimeWatch::Heard(std::size_t input, std::int64_t step, TimePoint time) {
  NoticeOwnPause(time);  // called first: a pause shifts the clock for the ticks
  const auto inputs = parts_.inputs.all();
  if (inputs[input].on_demand) return horizon_.KnowOf(step);
  // The world's ticks begin the steps of every role except the world itself.
  if (tick_input_ < inputs.size()) {
    if (!clock_.started()) health_[tick_input_] = InputHealth(limits_, period_, time - pause_.sum);
    Begun(step, time);
  }
  health_[input].Arrived(step, ClockOf(input, time));
}

void RealtimeWatch::Begun(std::int64_t step, TimePoint now) {
  clock_.Heard(step, now);
  horizon_.Heard(step, now);
}

TimePoint RealtimeWatch::Poll(TimePoint now, const std::function<TimePoint(TimePoint now)>& fire) {
  NoticeOwnPause(std::max(now, Clock::now()));
  parts_.bus.Drain();  // handles the backlog, at most kDrained messages
  if (!parts_.own.Running()) return now;
  now = std::max(now, Clock::now());  // handling a backlog takes time
  const TimePoint health_at = UpdateHealth(now);
  const TimePoint fire_at = fire(now);
  return pause_.wake = std::min({now + OwnStatus::kHeartbeat, health_at, fire_at});
}

void RealtimeWatch::NoticeOwnPause(TimePoint now) {
  if (pause_.wake == TimePoint::max() || now <= pause_.wake) return;
  const Duration late = now - pause_.wake;
  if (late > kLateCall * std::chrono::duration<double>(period_)) pause_.sum += late;
  pause_.wake = TimePoint::max();  // counts each pause once
}

InputState RealtimeWatch::StateFor(std::size_t input, std::int64_t step) const {
  const bool ticks = input == tick_input_ && parts_.inputs.all()[input].ring.Has(step);
  return ticks ? InputState::kOk : StateOf(input);
}

bool RealtimeWatch::Speaks(std::size_t input, TimePoint now) const {
  const TimePoint last = std::max(late_[input].at, parts_.inputs.all()[input].heard);
  return now - last <= kSpeaks * period_;
}

void RealtimeWatch::ComputeDue(std::int64_t step, TimePoint due, TimePoint now) {
  const std::int64_t next = parts_.steps.next();
  if (next > 0) {
    for (std::int64_t missed = next; missed < step; ++missed) statistics_.Miss();
  }
  if (!parts_.steps.Compute(step)) return;
  statistics_.Tick(due, now);
  const std::string& fallback = parts_.own.message().fallback;
  if (fallback == fallback_) return;
  fallback_ = fallback;
  parts_.own.Publish();
}

TimePoint RealtimeWatch::UpdateHealth(TimePoint now) {
  if (tick_input_ < parts_.inputs.all().size() && !clock_.started()) return TimePoint::max();
  const status_t& status = parts_.own.message();
  TimePoint next = TimePoint::max();
  bool changed = false;
  for (std::size_t i = 0; i < health_.size(); ++i) {
    const std::int8_t before =
        i < status.input_state.size() ? status.input_state[i] : std::int8_t{-1};
    const auto state = static_cast<std::int8_t>(health_[i].Update(ClockOf(i, now)));
    changed = changed || state != before;
    const TimePoint change = health_[i].NextChange();
    if (change == TimePoint::max()) continue;
    next = std::min(next, i == tick_input_ ? change + pause_.sum : clock_.Wall(change));
  }
  if (changed) parts_.own.Publish();
  return next;
}

void RealtimeWatch::WriteStatus(TimePoint now) {
  status_t& status = parts_.own.message();
  ClearInputs(status);
  for (std::size_t i = 0; i < health_.size(); ++i) {
    WriteInput(kChannels[parts_.inputs.all()[i].channel].name, health_[i], ClockOf(i, now), status);
    status.input_late.back() += late_[i].count;
  }
  statistics_.Write(status);
  // The time of the newest step of the run; the role itself may be at an earlier step.
  const std::int64_t newest = std::max(horizon_.newest(), parts_.steps.next() - 1);
  status.header.utime = std::max<std::int64_t>(0, newest) * step_us_;
  NameCulprit(now);
}

void RealtimeWatch::NameCulprit(TimePoint now) {
  const auto inputs = parts_.inputs.all();
  ChannelSet lost;
  ChannelSet stale;
  for (std::size_t i = 0; i < health_.size(); ++i) {
    if (health_[i].state() == InputState::kLost) lost.set(inputs[i].channel);
    if (health_[i].state() == InputState::kStale) stale.set(inputs[i].channel);
  }
  const auto culprit = FindCulprit(lost.any() ? lost : stale, {});
  if (!culprit) return;
  const auto input = static_cast<std::size_t>(
      std::ranges::find(inputs, culprit->channel, &Input::channel) - inputs.begin());
  const std::int64_t age_ms = Milliseconds(health_[input].Age(ClockOf(input, now)));
  status_t& status = parts_.own.message();
  status.waiting_for = kChannels[culprit->channel].name;
  status.last_heard_step = health_[input].newest();
  status.last_heard_ms = status.last_heard_step < 0 ? 0 : age_ms;
  status.waiting_ms = age_ms;
}

}  // namespace fogline::runtime
