#include "services/runtime/realtime/realtime_rule.h"

#include <algorithm>
#include <cmath>

#include "services/runtime/realtime/culprit.h"

namespace fogline::runtime {
namespace {

// The number of steps by which the world may be ahead of the estimate. The first step: a tick may
// be early by the delay of an earlier tick, which is less than a period. The second step: a message
// was on its way for a moment.
constexpr std::int64_t kSlack = 2;
// The greatest age of the progress that the runner reports: five signs of life of the roles, some
// of which may be lost.
constexpr Duration kHearsay = milliseconds(1000);
// How long a proof of the run's progress counts (step_horizon.h). A message that is sent again
// comes late, but a message that is older than a ring is not sent again. The runner reports old
// progress while it hears nothing itself, which lasts less than a minute in a run that goes on.
constexpr std::int64_t kHeardPeriods = kRingSteps;
constexpr Duration kToldFor = milliseconds(60'000);

}  // namespace

Duration PeriodOf(const Scenario& scenario, double speed) {
  return duration_cast<Duration>(std::chrono::duration<double>(scenario.step_s / speed));
}

RealtimeRule::RealtimeRule(Node& node, const Scenario& scenario, double speed)
    : FireRule(node),
      period_(PeriodOf(scenario, speed)),
      step_us_(std::llround(scenario.step_s * kMicrosPerSecond)),
      limits_(scenario.health),
      clock_(period_, Clock::now()),
      heard_(period_, kSlack, kHeardPeriods * period_),
      told_(period_, kSlack + kHearsay / period_, kToldFor),
      tick_input_(static_cast<std::size_t>(
          std::ranges::find(inputs(), Role::kWorld,
                            [](const Input& input) { return kChannels[input.channel].from; }) -
          inputs().begin())),
      late_(inputs().size()),
      late_at_(inputs().size()) {
  const TimePoint began = clock_.At(Clock::now());
  const auto judged = std::ranges::count(inputs(), false, &Input::on_demand);
  health_.assign(static_cast<std::size_t>(judged), InputHealth(limits_, period_, began));
  told_.Heard(progress(), Clock::now());
}

void RealtimeRule::OnProgress() { told_.Heard(progress(), Clock::now()); }

std::int64_t RealtimeRule::NewestPossible(TimePoint now) const {
  const std::int64_t told = told_.Newest(now);
  const bool hears = heard_.known() && clock_.Silence(now) <= kUnheard * period_;
  return hears ? std::min(heard_.Newest(now), told) : told;
}

void RealtimeRule::Begun(std::int64_t step, TimePoint now) {
  clock_.Heard(step, now);
  heard_.Heard(step, now);
  KnowOf(step);
}

StepRing::Verdict RealtimeRule::Classify(std::size_t input, std::int64_t step, Bytes bytes) {
  const Input& from = inputs()[input];
  const StepRing& ring = from.ring;
  if (ring.Has(step) && std::ranges::equal(ring.Get(step), bytes)) {
    return StepRing::Verdict::kDuplicate;
  }
  // For an input on demand the newest message counts, whatever its step.
  const bool late = from.on_demand ? step <= ring.newest()
                                   : step < next() - from.lag ||
                                         step <= ring.newest() - kRingSteps || ring.Has(step);
  if (late) {
    CountLate(input);
    return StepRing::Verdict::kLate;
  }
  return step <= NewestPossible(Clock::now()) ? StepRing::Verdict::kNew
                                              : StepRing::Verdict::kOutOfWindow;
}

void RealtimeRule::CountLate(std::size_t input) {
  ++late_[input];
  late_at_[input] = Clock::now();
}

void RealtimeRule::OnInput(std::size_t input, std::int64_t step, TimePoint time) {
  NoticeOwnPause(time);  // first, because the pause stops the clock that judges inputs
  if (inputs()[input].on_demand) return KnowOf(step);
  // each role but the world has an input that begins its steps
  if (tick_input_ < inputs().size()) {
    if (!clock_.started()) health_[tick_input_] = InputHealth(limits_, period_, time - paused_);
    Begun(step, time);
  }
  health_[input].Arrived(step, ClockOf(input, time));
}

TimePoint RealtimeRule::Poll(TimePoint now) {
  NoticeOwnPause(std::max(now, Clock::now()));
  bus().Drain();  // handles a backlog as a whole
  if (!Running()) return now;
  now = std::max(now, Clock::now());  // handling a backlog takes time
  const TimePoint health_at = UpdateHealth(now);
  const TimePoint fire_at = Fire(now);
  return wake_ = std::min({now + kHeartbeat, health_at, fire_at});
}

void RealtimeRule::NoticeOwnPause(TimePoint now) {
  if (wake_ == TimePoint::max() || now <= wake_) return;
  const Duration late = now - wake_;
  if (late > kGrace * std::chrono::duration<double>(period_)) paused_ += late;
  wake_ = TimePoint::max();  // counts each pause once
}

TimePoint RealtimeRule::Fire(TimePoint now) {
  const std::span<const Input> needed = awaited();
  std::int64_t newest = needed.front().ring.newest();
  for (const Input& input : needed) newest = std::min(newest, input.ring.newest());
  for (std::int64_t step = Oldest(newest); step <= newest && Running(); ++step) {
    const bool all =
        std::ranges::all_of(needed, [step](const Input& input) { return input.ring.Has(step); });
    if (!all) continue;
    const TimePoint due = std::ranges::max_element(needed, {}, &Input::heard)->heard;
    ComputeDue(step, due, now);
  }
  return now + kHeartbeat;
}

void RealtimeRule::ComputeDue(std::int64_t step, TimePoint due, TimePoint now) {
  if (next() > 0) {
    for (std::int64_t missed = next(); missed < step; ++missed) statistics_.Miss();
  }
  if (!Compute(step)) return;
  statistics_.Tick(due, now);
  if (status().fallback == fallback_) return;
  fallback_ = status().fallback;
  PublishStatus();
}

TimePoint RealtimeRule::UpdateHealth(TimePoint now) {
  if (tick_input_ < inputs().size() && !clock_.started()) return TimePoint::max();
  TimePoint next = TimePoint::max();
  bool changed = false;
  for (std::size_t i = 0; i < health_.size(); ++i) {
    const std::int8_t before =
        i < status().input_state.size() ? status().input_state[i] : std::int8_t{-1};
    const auto state = static_cast<std::int8_t>(health_[i].Update(ClockOf(i, now)));
    changed = changed || state != before;
    const TimePoint change = health_[i].NextChange();
    if (change == TimePoint::max()) continue;
    next = std::min(next, i == tick_input_ ? change + paused_ : clock_.Wall(change));
  }
  if (changed) PublishStatus();
  return next;
}

void RealtimeRule::WriteStatus(TimePoint now) {
  ClearInputs(status());
  for (std::size_t i = 0; i < health_.size(); ++i) {
    WriteInput(kChannels[inputs()[i].channel].name, health_[i], ClockOf(i, now), status());
    status().input_late.back() += late_[i];
  }
  statistics_.Write(status());
  // How far the run is; the role itself may be behind.
  status().header.utime = std::max<std::int64_t>(0, std::max(newest_, next() - 1)) * step_us_;
  NameCulprit(now);
}

void RealtimeRule::NameCulprit(TimePoint now) {
  ChannelSet lost;
  ChannelSet stale;
  for (std::size_t i = 0; i < health_.size(); ++i) {
    if (health_[i].state() == InputState::kLost) lost.set(inputs()[i].channel);
    if (health_[i].state() == InputState::kStale) stale.set(inputs()[i].channel);
  }
  const auto culprit = FindCulprit(lost.any() ? lost : stale, {});
  if (!culprit) return;
  const auto input = static_cast<std::size_t>(
      std::ranges::find(inputs(), culprit->channel, &Input::channel) - inputs().begin());
  const std::int64_t age_ms = Milliseconds(health_[input].Age(ClockOf(input, now)));
  status().waiting_for = kChannels[culprit->channel].name;
  status().last_heard_step = health_[input].newest();
  status().last_heard_ms = status().last_heard_step < 0 ? 0 : age_ms;
  status().waiting_ms = age_ms;
}

}  // namespace fogline::runtime
