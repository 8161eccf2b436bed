#include "services/runtime/lockstep/lockstep_rule.h"

namespace fogline::runtime {
namespace {

// If a role is asked for a step that it has not computed yet, the role asks for its own inputs. It
// does so only if its last request for inputs is at least this old.
constexpr Duration kMinBetweenAsks = milliseconds(2);

}  // namespace

LockstepRule::LockstepRule(Parts& parts, StepGate* gate)
    : parts_(parts), gate_(gate), expected_(parts.run.progress), late_(parts.run.progress) {
  if (gate_ != nullptr) gate_->BegunBefore(parts_.run.progress);
}

void LockstepRule::OnGo(const run_t& run, TimePoint now) {
  if (gate_ == nullptr) return;
  gate_->OnGo(run, now);
  Expect(next());
  Advance(now);
}

StepRing::Verdict LockstepRule::Judge(const Input& input, std::int64_t step, Bytes bytes) const {
  const auto verdict = input.ring.Classify(step, bytes, FirstNeeded(input));
  // A role that catches up also receives the current steps of the other roles. These steps are too
  // new for the role, so it ignores them. It does not count them as refused.
  const bool elsewhere = CatchingUp() && step <= late_ + kRingSteps;
  return verdict == StepRing::Verdict::kOutOfWindow && elsewhere ? StepRing::Verdict::kElsewhere
                                                                 : verdict;
}

void LockstepRule::OnInput(std::size_t input, std::int64_t step, Arrival& arrival) {
  Inputs& inputs = parts_.inputs;
  const auto verdict = Judge(inputs.all()[input], step, arrival.bytes());
  if (!inputs.Keep(input, step, arrival, verdict)) return;
  Expect(step);
  if (CatchingUp()) retry_.Arrived(arrival.time());
  Advance(arrival.time());
}

TimePoint LockstepRule::Poll(TimePoint now) {
  TimePoint at = now + OwnStatus::kHeartbeat;
  if (gate_ != nullptr) {
    at = std::min(at, PollGate(now));
    if (!parts_.own.Running()) return at;
  }
  Advance(now);
  return std::min(at, Repair(now));
}

TimePoint LockstepRule::PollGate(TimePoint now) {
  if (gate_->started()) Expect(next());
  if (gate_->Finished(next()) && FirstMissing() == nullptr) parts_.own.SetState(status_t::DONE);
  if (const auto step = gate_->WantsRecorded(next(), now)) {
    parts_.requests.Ask(ChannelOf<status_t>().name, {.first = *step, .count = 1});
  }
  return gate_->NextPoll(next(), now);
}

void LockstepRule::OnProgress() {
  const std::int64_t progress = parts_.run.progress;
  if (gate_ != nullptr) gate_->BegunBefore(progress);
  Expect(progress);
  if (progress > next() + kMaxAhead) late_ = progress;
}

void LockstepRule::OnAskedAhead(std::int64_t step, TimePoint now) {
  // A request may name a step that is much too high, so the expected step is limited.
  Expect(std::min(step, next() + kRingSteps - 1));
  // A role that catches up has already asked for its inputs.
  if (!CatchingUp() && now - retry_.asked() >= kMinBetweenAsks) AskForMissing(now);
}

void LockstepRule::WriteStatus(TimePoint now) {
  const Input* missing = retry_.since() ? FirstMissing() : nullptr;
  if (missing == nullptr) return;
  status_t& status = parts_.own.message();
  status.waiting_for = kChannels[missing->channel].name;
  status.last_heard_step = missing->ring.newest();
  status.last_heard_ms = status.last_heard_step < 0 ? 0 : Milliseconds(now - missing->heard);
  status.waiting_ms = Milliseconds(now - *retry_.since());
}

void LockstepRule::SetFinal(std::int64_t step) {
  if (gate_ != nullptr) gate_->SetFinal(step);
}

const Input* LockstepRule::FirstMissing() const {
  const auto inputs = parts_.inputs.all();
  const auto missing = std::ranges::find_if_not(
      inputs, [this](const Input& input) { return input.ReadyFor(next()); });
  return missing == inputs.end() ? nullptr : &*missing;
}

std::int64_t LockstepRule::FirstNeeded(const Input& input) const {
  return std::max<std::int64_t>(0, next() - input.lag);
}

void LockstepRule::Advance(TimePoint now) {
  while (parts_.own.Running() && FirstMissing() == nullptr &&
         (gate_ == nullptr || gate_->Open(next(), now))) {
    if (!parts_.steps.Compute(next())) return;
    retry_.Computed(now);
  }
}

TimePoint LockstepRule::Repair(TimePoint now) {
  if (expected_ < next() || FirstMissing() == nullptr) return now + OwnStatus::kHeartbeat;
  const TimePoint ask_at = retry_.Wait(now);
  // A role that catches up gets old inputs only on request. If it has not asked for the inputs of
  // this step yet, it asks immediately.
  if (CatchingUp() && next() > asked_) {
    AskForMissing(now);
    retry_.AskedForMany(now);
  } else if (now >= ask_at) {
    AskForMissing(now);
    retry_.AskedInVain(now);
  }
  return retry_.Wait(now);
}

void LockstepRule::AskForMissing(TimePoint now) {
  retry_.Asked(now);
  // Asks for the steps up to the newest step that is known to have begun. The size of the rings
  // limits the number of these steps.
  asked_ = std::clamp(expected_, next(), next() + kRingSteps - 2);
  for (const Input& input : parts_.inputs.all()) {
    const StepRange steps = Lacking(input, FirstNeeded(input), asked_ - input.lag);
    if (steps.count == 0) continue;
    parts_.requests.Ask(kChannels[input.channel].name, steps);
    ++parts_.own.message().repairs_asked;
  }
}

StepRange LockstepRule::Lacking(const Input& input, std::int64_t first, std::int64_t last) const {
  if (CatchingUp()) {  // old steps come only on request
    while (first <= last && input.ring.Has(first)) ++first;
    while (first <= last && input.ring.Has(last)) --last;
    return {.first = first, .count = last - first + 1};
  }
  // Asks only for step `first`, if it is missing, and for the missing steps directly after it.
  // Later missing steps may still be on their way.
  std::int64_t count = 0;
  while (first + count <= last && !input.ring.Has(first + count)) ++count;
  return {.first = first, .count = count};
}

}  // namespace fogline::runtime
