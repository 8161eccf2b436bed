#include "services/runtime/realtime/tick_rule.h"

#include <algorithm>
#include <utility>

namespace fogline::runtime {
namespace {

// How long the recorder may take to write the last steps. It may wait for repairs or be started
// again itself.
constexpr Duration kEndLimit = milliseconds(3000);
// A world that is started again asks the recorder at this interval. It takes the newest answer that
// comes within kAnswersLast after the first.
constexpr Duration kAskEvery = milliseconds(20);
constexpr Duration kAnswersLast = milliseconds(5);
// A world that is started again asks for steps from this many before the known progress on.
constexpr std::int64_t kProgressAge = 8;
// A tick that is later than this, in periods, was held up by more than the usual jitter.
constexpr double kHeldUp = 0.05;
// After such a tick the other roles get at most this long to finish the step before, which is
// several times what they need. The next tick is at least kApart periods away.
constexpr Duration kFinish = milliseconds(3);
constexpr double kApart = 0.25;

Duration operator*(double share, Duration period) {
  return duration_cast<Duration>(share * std::chrono::duration<double>(period));
}

}  // namespace

TickRule::TickRule(Node& node, const Scenario& scenario, double speed, StepGate& gate,
                   TakeOver take_over)
    : RealtimeRule(node, scenario, speed),
      gate_(gate),
      take_over_(std::move(take_over)),
      steps_(scenario.steps) {}

void TickRule::OnGo(const run_t& run, TimePoint now) {
  if (phase_ != Phase::kWaiting) return;
  gate_.OnGo(run, now);
  start_ = now;
  phase_ = progress() < 0 ? Phase::kTicking : Phase::kResuming;
}

StepRing::Verdict TickRule::Classify(std::size_t input, std::int64_t step, Bytes bytes) {
  const StepRing::Verdict verdict = RealtimeRule::Classify(input, step, bytes);
  if (verdict == StepRing::Verdict::kLate) TakeLatency(input, step, Clock::now());
  return verdict;
}

void TickRule::OnInput(std::size_t input, std::int64_t step, TimePoint time) {
  RealtimeRule::OnInput(input, step, time);
  TakeLatency(input, step, time);
}

void TickRule::TakeLatency(std::size_t input, std::int64_t step, TimePoint time) {
  Sent& sent = sent_[RingSlot(step)];
  if (inputs()[input].channel != IndexOf<arbitration_t>() || sent.step != step) return;
  statistics().Latency(time - sent.time);
  sent.step = -1;
}

void TickRule::SetFinal(std::int64_t step) {
  gate_.SetFinal(step);
  phase_ = Phase::kEnding;
}

void TickRule::WriteStatus(TimePoint now) {
  RealtimeRule::WriteStatus(now);
  status().ticks_missed = ticks_missed_;
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
  return now + kHeartbeat;
}

TimePoint TickRule::Due(std::int64_t n) const {
  return start_ +
         duration_cast<Duration>(static_cast<double>(n) * std::chrono::duration<double>(period()));
}

bool TickRule::Answered() const {
  const std::int64_t step = next();
  return std::ranges::all_of(inputs(), [step](const Input& input) { return input.ReadyFor(step); });
}

TimePoint TickRule::Tick(TimePoint now) {
  if (now < Due(tick_)) return Due(tick_);
  const bool answered = Answered();
  if (!answered && now - Due(tick_) > kHeldUp * period()) {
    if (!finish_by_) finish_by_ = now + std::min(kFinish, kApart * period());
    if (now < *finish_by_) return *finish_by_;
  }
  finish_by_.reset();
  if (!answered) statistics().Miss();
  std::int64_t missed = (now - Due(tick_)) / period();
  tick_ += missed;
  const TimePoint due = Due(tick_);
  ++tick_;
  if (Due(tick_) - now < kApart * period()) {
    ++tick_;
    ++missed;
  }
  ticks_missed_ += missed;
  const std::int64_t step = next();
  Begun(step, now);
  ComputeDue(step, due, now);
  sent_[RingSlot(step)] = {.step = step, .time = Clock::now()};
  return phase_ == Phase::kTicking ? Due(tick_) : now;
}

TimePoint TickRule::End(TimePoint now) {
  if (!give_up_at_) give_up_at_ = now + kEndLimit;
  if (gate_.Finished(next()) || now >= *give_up_at_) {
    SetState(status_t::DONE);
    return now + kHeartbeat;
  }
  if (const auto step = gate_.WantsRecorded(next(), now)) {
    Ask(ChannelOf<status_t>().name, {.first = *step, .count = 1});
  }
  return std::min(*give_up_at_, gate_.NextPoll(next(), now));
}

TimePoint TickRule::Resume(TimePoint now) {
  start_ = now;
  phase_ = Phase::kTicking;  // take_over_ sets another phase if the run ends with this step
  try {
    take_over_(*truth_);
  } catch (const std::exception&) {  // the TRUTH does not fit this scenario
    ++status().malformed;
    truth_.reset();
    phase_ = Phase::kResuming;
    return ask_at_;
  }
  return now;
}

std::int64_t TickRule::FirstAsked() { return std::max<std::int64_t>(0, progress() - kProgressAge); }

// The TRUTH must be of this run, and its step must be near the known progress.
bool TickRule::CanResume(const truth_t& truth) {
  return truth.header.run_id == status().header.run_id && truth.header.step >= 0 &&
         truth.header.step < std::min(steps_, FirstAsked() + kRingSteps);
}

TimePoint TickRule::LookForTruth(TimePoint now) {
  if (!subscribed_) {
    subscribed_ = true;
    bus().Subscribe(ChannelOf<truth_t>().name, [this](Arrival& arrival) {
      const auto* truth = arrival.As<truth_t>();
      if (phase_ != Phase::kResuming || truth == nullptr || !CanResume(*truth)) return;
      if (!truth_) truth_at_ = arrival.time();
      if (!truth_ || truth->header.step > truth_->header.step) truth_ = *truth;
    });
  }
  if (truth_ && now >= truth_at_ + kAnswersLast) {
    return Resume(now);
  }
  if (now >= ask_at_) {
    ask_at_ = now + kAskEvery;
    const std::int64_t first = FirstAsked();
    Ask(ChannelOf<truth_t>().name, {.first = first, .count = kRingSteps});
    // Also asks for the commands of these steps, from their producers.
    for (const Input& input : inputs()) {
      Ask(kChannels[input.channel].name, {.first = first, .count = kRingSteps});
    }
    ++status().repairs_asked;
  }
  return truth_ ? truth_at_ + kAnswersLast : ask_at_;
}

}  // namespace fogline::runtime
