#include "services/recorder/record_rule.h"

#include <algorithm>
#include <utility>

namespace fogline::recorder {
namespace {

// A message is asked for when it is kOverduePeriods periods late: kAsks times, at intervals of
// kAskEvery.
constexpr double kOverduePeriods = 1.5;
constexpr int kAsks = 4;
constexpr Duration kAskEvery = milliseconds(20);
// The most incomplete steps: half of the steps that producers keep. The other half leaves time for
// their answers.
constexpr std::int64_t kMaxOpen = runtime::kRingSteps / 2;
// The most STATUS messages that wait to be written: several of each role in each open step.
constexpr std::size_t kMaxHeard = 4096;

}  // namespace

RecordRule::RecordRule(runtime::Node& node, const Scenario& scenario, double speed,
                       std::int64_t run_id)
    : runtime::RealtimeRule(node, scenario, speed), run_id_(run_id) {}

void RecordRule::ListenToStatus() {
  listening_ = true;
  bus().Subscribe(ChannelOf<status_t>().name, [this](runtime::Arrival& arrival) {
    const auto* status = arrival.As<status_t>();
    if (status == nullptr || status->header.run_id != run_id_ || heard_.size() >= kMaxHeard) return;
    const runtime::Bytes bytes = arrival.bytes();
    heard_.push_back(
        {.step = std::max<std::int64_t>(newest(), 0), .bytes = {bytes.begin(), bytes.end()}});
  });
}

void RecordRule::TakeStatus(std::int64_t step, const std::function<void(runtime::Bytes)>& use) {
  for (; !heard_.empty() && heard_.front().step <= step; heard_.pop_front()) {
    use(heard_.front().bytes);
  }
}

runtime::StepRing::Verdict RecordRule::Classify(std::size_t input, std::int64_t step,
                                                runtime::Bytes bytes) {
  const runtime::StepRing::Verdict verdict = runtime::RealtimeRule::Classify(input, step, bytes);
  const runtime::StepRing& ring = inputs()[input].ring;
  // The log has the message if the ring has its step. Whether the log has the message of a step
  // older than the ring is not known.
  if (verdict != runtime::StepRing::Verdict::kLate || ring.Has(step) ||
      step <= ring.newest() - runtime::kRingSteps) {
    return verdict;
  }
  Refused& refused = refused_[input];
  if (std::exchange(refused.steps[runtime::RingSlot(step)], step + 1) != step + 1) ++refused.count;
  return verdict;
}

void RecordRule::WriteStatus(TimePoint now) {
  runtime::RealtimeRule::WriteStatus(now);
  for (std::size_t i = 0; i < status().input_late.size(); ++i) {
    status().input_late[i] = refused_[i].count;
  }
}

void RecordRule::OnInput(std::size_t input, std::int64_t step, TimePoint time) {
  OpenUpTo(step, time);
  OpenAt(step, time);
  runtime::RealtimeRule::OnInput(input, step, time);
}

void RecordRule::OnProgress() {
  runtime::RealtimeRule::OnProgress();
  const TimePoint now = Clock::now();
  const std::int64_t step = std::min(progress(), NewestPossible(now));
  if (step <= newest()) return;
  OpenUpTo(step, now);
  KnowOf(step);
}

void RecordRule::OpenUpTo(std::int64_t step, TimePoint now) {
  for (std::int64_t k = std::max({next(), newest() + 1, step - runtime::kRingSteps + 1}); k <= step;
       ++k) {
    OpenAt(k, now);
  }
}

RecordRule::Open& RecordRule::OpenAt(std::int64_t step, TimePoint now) {
  Open& open = open_[runtime::RingSlot(step)];
  if (open.step != step) open = {.step = step, .seen = now};
  return open;
}

TimePoint RecordRule::Fire(TimePoint now) {
  if (!listening_) ListenToStatus();
  while (Running() && next() <= newest() && (Complete(next()) || GivenUp(next(), now))) {
    const TimePoint due = std::ranges::max_element(inputs(), {}, &Input::heard)->heard;
    ComputeDue(next(), due, now);
  }
  if (!Running() || next() > newest()) return now + kHeartbeat;
  if (now >= ask_at_) AskForHoles(now);
  return ask_at_;
}

bool RecordRule::Complete(std::int64_t step) const {
  return std::ranges::all_of(inputs(), [step](const Input& input) { return input.ring.Has(step); });
}

bool RecordRule::GivenUp(std::int64_t step, TimePoint now) {
  const Open& open = OpenAt(step, now);
  return step <= newest() - kMaxOpen ||
         (open.asked >= kAsks && now > open.asked_at + 2 * kAskEvery);
}

void RecordRule::AskForHoles(TimePoint now) {
  ask_at_ = now + kAskEvery;
  const auto overdue =
      duration_cast<Duration>(kOverduePeriods * std::chrono::duration<double>(period()));
  std::int64_t end = next();  // end of the steps to be asked for
  while (end <= newest() && now >= OpenAt(end, now).seen + overdue) ++end;
  std::int64_t first = next();
  while (first < end && OpenAt(first, now).asked >= kAsks) ++first;
  for (const Input& input : inputs()) {
    for (std::int64_t step = first; step < end; ++step) {
      if (input.ring.Has(step)) continue;
      std::int64_t count = 1;
      while (step + count < end && !input.ring.Has(step + count)) ++count;
      Ask(kChannels[input.channel].name, {.first = step, .count = count});
      ++status().repairs_asked;
      step += count;
    }
  }
  for (std::int64_t step = first; step < end; ++step) {
    Open& open = OpenAt(step, now);
    ++open.asked;
    open.asked_at = now;
  }
}

}  // namespace fogline::recorder
