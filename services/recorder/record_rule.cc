#include "services/recorder/record_rule.h"

#include <algorithm>
#include <utility>

#include "services/runtime/wire/driver_input.h"

namespace fogline::recorder {
namespace {

// The recorder asks for a message that is kOverduePeriods periods late. It asks kAsks times at
// most, at intervals of kAskEvery.
constexpr double kOverduePeriods = 1.5;
constexpr int kAsks = 4;
constexpr Duration kAskEvery = milliseconds(20);
// At most this many steps may be incomplete: half of the number of steps that a producer stores.
// The other half leaves time for the producers' answers.
constexpr std::int64_t kMaxOpen = runtime::kRingSteps / 2;
// At most this many STATUS, DRIVER_INPUT and TRIAL messages may wait to be written: several from
// each role in each open step.
constexpr std::size_t kMaxHeard = 4096;
// A number of seats. In a second, the recorder logs at most as many DRIVER_INPUT messages as these
// seats may send. So a flood of messages cannot fill the memory or the disk.
constexpr double kSeats = 4;

}  // namespace

RecordRule::RecordRule(runtime::Parts& parts, const Scenario& scenario)
    : parts_(parts),
      watch_(parts, scenario),
      overdue_(duration_cast<Duration>(
          kOverduePeriods *
          std::chrono::duration<double>(runtime::PeriodOf(scenario, parts.run.pace)))),
      inputs_per_s_(kSeats * runtime::kMostInputsPerSecond, kSeats * runtime::kMostInputsAtOnce) {
  ListenToInputs();
}

void RecordRule::Listen() {
  listening_ = true;
  parts_.bus.Subscribe(ChannelOf<status_t>().name, [this](runtime::Arrival& arrival) {
    const auto* status = arrival.As<status_t>();
    if (status == nullptr || status->header.run_id != *parts_.run.id) return;
    Hear(IndexOf<status_t>(), arrival.bytes());
  });
}

// Subscribes to DRIVER_INPUT and TRIAL. The constructor calls this function, because the driver
// uses inputs from the first TRUTH on, and the recorder joins before this TRUTH.
void RecordRule::ListenToInputs() {
  // The driver refuses and counts invalid DRIVER_INPUT messages. The recorder only ignores them. No
  // other role reads TRIAL, so the recorder counts what it refuses.
  parts_.bus.Subscribe(ChannelOf<driver_input_t>().name, [this](runtime::Arrival& arrival) {
    const auto* input = arrival.As<driver_input_t>();
    if (input == nullptr || input->header.run_id != *parts_.run.id ||
        runtime::WrongIn(*input) != nullptr || !inputs_per_s_.Take(arrival.time())) {
      return;
    }
    Hear(IndexOf<driver_input_t>(), arrival.bytes());
  });
  parts_.bus.Subscribe(ChannelOf<trial_t>().name, [this](runtime::Arrival& arrival) {
    if (const runtime::RefusalCounter wrong = WhyRefused(arrival)) return parts_.own.Refuse(wrong);
    Hear(IndexOf<trial_t>(), arrival.bytes());
  });
}

runtime::RefusalCounter RecordRule::WhyRefused(runtime::Arrival& trial) {
  if (const runtime::RefusalCounter wrong = trial.Wrong<trial_t>()) return wrong;
  const trial_t& fact = *trial.As<trial_t>();
  if (fact.header.run_id != *parts_.run.id) return &status_t::foreign;
  if (const runtime::RefusalCounter wrong = runtime::WrongIn(fact)) return wrong;
  return facts_per_s_.Take(trial.time()) ? nullptr : &status_t::too_frequent;
}

void RecordRule::Hear(std::size_t channel, runtime::Bytes bytes) {
  if (heard_.size() >= kMaxHeard) return;
  heard_.push_back({.step = std::max<std::int64_t>(watch_.horizon().newest(), 0),
                    .channel = channel,
                    .bytes = {bytes.begin(), bytes.end()}});
}

void RecordRule::TakeEvents(
    std::int64_t step, const std::function<void(std::string_view channel, runtime::Bytes)>& use) {
  for (; !heard_.empty() && heard_.front().step <= step; heard_.pop_front()) {
    use(kChannels[heard_.front().channel].name, heard_.front().bytes);
  }
}

void RecordRule::OnInput(std::size_t input, std::int64_t step, runtime::Arrival& arrival) {
  const auto verdict = watch_.Judge(input, step, arrival.bytes());
  if (verdict == runtime::StepRing::Verdict::kLate) CountRefused(input, step);
  if (!parts_.inputs.Keep(input, step, arrival, verdict)) return;
  OpenUpTo(step, arrival.time());
  OpenAt(step, arrival.time());
  watch_.Heard(input, step, arrival.time());
}

void RecordRule::CountRefused(std::size_t input, std::int64_t step) {
  const runtime::StepRing& ring = parts_.inputs.all()[input].ring;
  // If the ring has the input's message of this step, the log has the message, too. If the step is
  // older than the ring, the recorder does not know whether the log has the message. In both cases
  // the message is not counted.
  if (ring.Has(step) || step <= ring.newest() - runtime::kRingSteps) return;
  Refused& refused = refused_[input];
  if (std::exchange(refused.steps[runtime::RingSlot(step)], step + 1) != step + 1) ++refused.count;
}

void RecordRule::WriteStatus(TimePoint now) {
  watch_.WriteStatus(now);
  std::vector<std::int64_t>& late = parts_.own.message().input_late;
  for (std::size_t i = 0; i < late.size(); ++i) late[i] = refused_[i].count;
}

void RecordRule::OnProgress() {
  watch_.OnProgress();
  const TimePoint now = Clock::now();
  const std::int64_t step = std::min(parts_.run.progress, watch_.NewestPossible(now));
  if (step <= watch_.horizon().newest()) return;
  OpenUpTo(step, now);
  watch_.horizon().KnowOf(step);
}

void RecordRule::OpenUpTo(std::int64_t step, TimePoint now) {
  const std::int64_t first = std::max(
      {parts_.steps.next(), watch_.horizon().newest() + 1, step - runtime::kRingSteps + 1});
  for (std::int64_t k = first; k <= step; ++k) OpenAt(k, now);
}

RecordRule::Open& RecordRule::OpenAt(std::int64_t step, TimePoint now) {
  Open& open = open_[runtime::RingSlot(step)];
  if (open.step != step) open = {.step = step, .seen = now};
  return open;
}

TimePoint RecordRule::Poll(TimePoint now) {
  return watch_.Poll(now, [this](TimePoint time) { return Fire(time); });
}

TimePoint RecordRule::Fire(TimePoint now) {
  if (!listening_) Listen();
  const auto inputs = parts_.inputs.all();
  const auto is_due = [&, this] {
    const std::int64_t next = parts_.steps.next();
    return parts_.own.Running() && next <= watch_.horizon().newest() &&
           (Complete(next) || GivenUp(next, now));
  };
  while (is_due()) {
    const TimePoint due = std::ranges::max_element(inputs, {}, &runtime::Input::heard)->heard;
    watch_.ComputeDue(parts_.steps.next(), due, now);
  }
  if (!parts_.own.Running() || parts_.steps.next() > watch_.horizon().newest()) {
    return now + runtime::OwnStatus::kHeartbeat;
  }
  if (now >= ask_at_) AskForHoles(now);
  return ask_at_;
}

bool RecordRule::Complete(std::int64_t step) const {
  return std::ranges::all_of(parts_.inputs.all(),
                             [step](const runtime::Input& input) { return input.ring.Has(step); });
}

bool RecordRule::GivenUp(std::int64_t step, TimePoint now) {
  const Open& open = OpenAt(step, now);
  return step <= watch_.horizon().newest() - kMaxOpen ||
         (open.asked >= kAsks && now > open.asked_at + 2 * kAskEvery);
}

void RecordRule::AskForHoles(TimePoint now) {
  ask_at_ = now + kAskEvery;
  const std::int64_t newest = watch_.horizon().newest();
  std::int64_t end = parts_.steps.next();  // the step after the last step to ask for
  while (end <= newest && now >= OpenAt(end, now).seen + overdue_) ++end;
  std::int64_t first = parts_.steps.next();
  while (first < end && OpenAt(first, now).asked >= kAsks) ++first;
  for (const runtime::Input& input : parts_.inputs.all()) {
    for (std::int64_t step = first; step < end; ++step) {
      if (input.ring.Has(step)) continue;
      std::int64_t count = 1;
      while (step + count < end && !input.ring.Has(step + count)) ++count;
      parts_.requests.Ask(kChannels[input.channel].name, {.first = step, .count = count});
      ++parts_.own.message().repairs_asked;
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
