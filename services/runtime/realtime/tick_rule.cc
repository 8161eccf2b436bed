#include "services/runtime/realtime/tick_rule.h"

#include <algorithm>
#include <utility>

namespace fogline::runtime {
namespace {

// How long the recorder may take to write the last steps. In this time, the recorder may wait for
// repairs, or its process may be started again.
constexpr Duration kEndLimit = milliseconds(3000);
// A world that is started again asks the recorder at this interval. The world takes the newest
// answer that comes within kAnswersLast after the first answer.
constexpr Duration kAskEvery = milliseconds(20);
constexpr Duration kAnswersLast = milliseconds(5);
// RUN tells a restarted world which step the run has reached. The first step that this world asks
// for is this many steps earlier.
constexpr std::int64_t kProgressAge = 8;
// A tick counts as delayed if it is late by more than this share of a period. The usual jitter is
// smaller.
constexpr double kHeldUp = 0.05;
// A delayed tick waits until the other roles have finished the previous step, but at most this
// long. The roles usually need a fraction of this time. The next tick comes at least kApart periods
// after the delayed tick.
constexpr Duration kFinish = milliseconds(3);
constexpr double kApart = 0.25;

Duration operator*(double share, Duration period) {
  return duration_cast<Duration>(share * std::chrono::duration<double>(period));
}

}  // namespace

TickRule::TickRule(Parts& parts, const Scenario& scenario, StepGate& gate, TakeOver take_over)
    : parts_(parts),
      watch_(parts, scenario),
      gate_(gate),
      take_over_(std::move(take_over)),
      grid_{.period = PeriodOf(scenario, parts.run.pace)} {}

void TickRule::OnGo(const run_t& run, TimePoint now) {
  if (phase_ != Phase::kWaiting) return;
  gate_.OnGo(run, now);
  grid_.start = now;
  phase_ = parts_.run.progress < 0 ? Phase::kTicking : Phase::kResuming;
}

void TickRule::OnInput(std::size_t input, std::int64_t step, Arrival& arrival) {
  const auto verdict = watch_.Judge(input, step, arrival.bytes());
  if (verdict == StepRing::Verdict::kLate) TakeLatency(input, step, Clock::now());
  if (!parts_.inputs.Keep(input, step, arrival, verdict)) return;
  watch_.Heard(input, step, arrival.time());
  TakeLatency(input, step, arrival.time());
}

TimePoint TickRule::Poll(TimePoint now) {
  return watch_.Poll(now, [this](TimePoint time) { return Fire(time); });
}

void TickRule::TakeLatency(std::size_t input, std::int64_t step, TimePoint time) {
  Sent& sent = sent_[RingSlot(step)];
  const std::size_t channel = parts_.inputs.all()[input].channel;
  if (channel != IndexOf<arbitration_t>() || sent.step != step) return;
  watch_.statistics().Latency(time - sent.time);
  sent.step = -1;
}

void TickRule::SetFinal(std::int64_t step) {
  gate_.SetFinal(step);
  phase_ = Phase::kEnding;
}

void TickRule::WriteStatus(TimePoint now) {
  watch_.WriteStatus(now);
  parts_.own.message().ticks_missed = grid_.missed;
}

TimePoint TickRule::Fire(TimePoint now) {
  switch (phase_) {
    case Phase::kWaiting:
      break;
    case Phase::kResuming:
      return LookForTruth(now);
    case Phase::kTicking:
      return Tick(now);
    case Phase::kEnding:
      return End(now);
  }
  return now + OwnStatus::kHeartbeat;
}

TimePoint TickRule::Due(std::int64_t n) const {
  return grid_.start + duration_cast<Duration>(static_cast<double>(n) *
                                               std::chrono::duration<double>(grid_.period));
}

bool TickRule::Answered() const {
  const std::int64_t step = parts_.steps.next();
  return std::ranges::all_of(parts_.inputs.all(),
                             [step](const Input& input) { return input.ReadyFor(step); });
}

TimePoint TickRule::Tick(TimePoint now) {
  if (now < Due(grid_.next)) return Due(grid_.next);
  const bool answered = Answered();
  if (!answered && now - Due(grid_.next) > kHeldUp * grid_.period) {
    if (!finish_by_) finish_by_ = now + std::min(kFinish, kApart * grid_.period);
    if (now < *finish_by_) return *finish_by_;
  }
  finish_by_.reset();
  if (!answered) watch_.statistics().Miss();
  std::int64_t missed = (now - Due(grid_.next)) / grid_.period;
  grid_.next += missed;
  const TimePoint due = Due(grid_.next);
  ++grid_.next;
  if (Due(grid_.next) - now < kApart * grid_.period) {
    ++grid_.next;
    ++missed;
  }
  grid_.missed += missed;
  const std::int64_t step = parts_.steps.next();
  watch_.Begun(step, now);
  watch_.ComputeDue(step, due, now);
  sent_[RingSlot(step)] = {.step = step, .time = Clock::now()};
  return phase_ == Phase::kTicking ? Due(grid_.next) : now;
}

TimePoint TickRule::End(TimePoint now) {
  const std::int64_t next = parts_.steps.next();
  if (!give_up_at_) give_up_at_ = now + kEndLimit;
  if (gate_.Finished(next) || now >= *give_up_at_) {
    parts_.own.SetState(status_t::DONE);
    return now + OwnStatus::kHeartbeat;
  }
  if (const auto step = gate_.WantsRecorded(next, now)) {
    parts_.requests.Ask(ChannelOf<status_t>().name, {.first = *step, .count = 1});
  }
  return std::min(*give_up_at_, gate_.NextPoll(next, now));
}

TimePoint TickRule::Resume(TimePoint now) {
  grid_.start = now;
  phase_ = Phase::kTicking;  // take_over_ sets another phase if the run ends with this step
  try {
    take_over_(*search_.newest);
  } catch (const std::logic_error&) {  // the TRUTH does not fit this scenario
    ++parts_.own.message().malformed;
    search_.newest.reset();
    phase_ = Phase::kResuming;
    return search_.ask_at;
  } catch (const std::exception& error) {  // the world cannot go on
    parts_.own.Fail(error.what());
  }
  return now;
}

std::int64_t TickRule::FirstAsked() const {
  return std::max<std::int64_t>(0, parts_.run.progress - kProgressAge);
}

// The TRUTH must be of this run, and near the step that the run has reached.
bool TickRule::CanResume(const truth_t& truth) const {
  return truth.header.run_id == *parts_.run.id && truth.header.step >= 0 &&
         truth.header.step < std::min(parts_.run.steps, FirstAsked() + kRingSteps);
}

TimePoint TickRule::LookForTruth(TimePoint now) {
  if (!search_.listening) {
    search_.listening = true;
    parts_.bus.Subscribe(ChannelOf<truth_t>().name, [this](Arrival& arrival) {
      const auto* truth = arrival.As<truth_t>();
      if (phase_ != Phase::kResuming || truth == nullptr || !CanResume(*truth)) return;
      if (!search_.newest) search_.answered_at = arrival.time();
      if (!search_.newest || truth->header.step > search_.newest->header.step) {
        search_.newest = *truth;
      }
    });
  }
  if (search_.newest && now >= search_.answered_at + kAnswersLast) return Resume(now);
  if (now >= search_.ask_at) {
    search_.ask_at = now + kAskEvery;
    AskForTruth();
  }
  return search_.newest ? search_.answered_at + kAnswersLast : search_.ask_at;
}

void TickRule::AskForTruth() {
  const StepRange steps{.first = FirstAsked(), .count = kRingSteps};
  parts_.requests.Ask(ChannelOf<truth_t>().name, steps);
  // Also asks for the commands of these steps, from their producers.
  for (const Input& input : parts_.inputs.all()) {
    parts_.requests.Ask(kChannels[input.channel].name, steps);
  }
  ++parts_.own.message().repairs_asked;
}

}  // namespace fogline::runtime
