#include "services/runtime/lockstep_rule.h"

#include <algorithm>

namespace fogline {
namespace {

// Being asked makes a node ask at once, but no more often than this.
constexpr Duration kMinBetweenAsks = milliseconds(2);

}  // namespace

LockstepRule::LockstepRule(Node& node) : FireRule(node), expected_(progress()), late_(progress()) {}

StepRing::Verdict LockstepRule::Classify(std::size_t input, std::int64_t step, Bytes bytes) {
  const std::int64_t needed = std::max<std::int64_t>(0, next() - lead());
  const auto verdict = inputs()[input].ring.Classify(step, bytes, needed);
  // Who catches up hears of steps that are under way elsewhere.
  const bool elsewhere = CatchingUp() && step <= late_ + kRingSteps;
  return verdict == StepRing::Verdict::kOutOfWindow && elsewhere ? StepRing::Verdict::kElsewhere
                                                                 : verdict;
}

void LockstepRule::OnInput(std::size_t /*input*/, std::int64_t step, TimePoint time) {
  Expect(step + lead());
  if (CatchingUp()) patience_.Arrived(time);
  Advance(time);
}

TimePoint LockstepRule::Poll(TimePoint now) {
  Advance(now);
  return Repair(now);
}

void LockstepRule::OnProgress() {
  Expect(progress());
  if (progress() > next() + kMaxAhead) late_ = progress();
}

void LockstepRule::OnAskedAhead(std::int64_t step, TimePoint now) {
  // What somebody who asks may be wrong about is bounded.
  Expect(std::min(step, next() + kRingSteps - 1));
  // Who catches up has asked already.
  if (!CatchingUp() && now - patience_.asked() >= kMinBetweenAsks) AskForMissing(now);
}

void LockstepRule::WriteStatus(TimePoint now) {
  const Input* missing = patience_.since() ? FirstMissing() : nullptr;
  if (missing == nullptr) return;
  status().waiting_for = kChannels[missing->channel].name;
  status().last_heard_step = missing->ring.newest();
  status().last_heard_ms = status().last_heard_step < 0 ? 0 : Milliseconds(now - missing->heard);
  status().waiting_ms = Milliseconds(now - *patience_.since());
}

bool LockstepRule::InputsReady(std::int64_t step) const {
  return step < 0 ||
         std::ranges::all_of(inputs(), [step](const Input& input) { return input.ring.Has(step); });
}

const LockstepRule::Input* LockstepRule::FirstMissing() const {
  const std::int64_t needed = next() - lead();
  if (needed < 0) return nullptr;
  for (const Input& input : inputs()) {
    if (!input.ring.Has(needed)) return &input;
  }
  return nullptr;
}

void LockstepRule::Advance(TimePoint now) {
  while (Running() && InputsReady(next() - lead()) && MayCompute(next(), now)) {
    if (!Compute(next())) return;
    patience_.Computed(now);
  }
}

TimePoint LockstepRule::Repair(TimePoint now) {
  if (expected_ < next() || FirstMissing() == nullptr) return now + kHeartbeat;
  const TimePoint ask_at = patience_.Wait(now);
  if (CatchingUp() && next() - lead() > asked_) {  // nothing of it can be on its way
    AskForMissing(now);
    patience_.AskedForMany(now);
  } else if (now >= ask_at) {
    AskForMissing(now);
    patience_.AskedInVain(now);
  }
  return patience_.Wait(now);
}

void LockstepRule::AskForMissing(TimePoint now) {
  const std::int64_t needed = next() - lead();
  if (needed < 0) return;
  patience_.Asked(now);
  // As far as is known to be under way, and as the rings can hold.
  asked_ = std::clamp(expected_ - lead(), needed, needed + kRingSteps - 2);
  for (const Input& input : inputs()) {
    const StepRange steps = Lacking(input, needed, asked_);
    if (steps.count == 0) continue;
    Ask(kChannels[input.channel].name, steps);
    ++status().repairs_asked;
  }
}

StepRange LockstepRule::Lacking(const Input& input, std::int64_t first, std::int64_t last) const {
  if (CatchingUp()) {  // old steps come only to those who ask
    while (first <= last && input.ring.Has(first)) ++first;
    while (first <= last && input.ring.Has(last)) --last;
    return {.first = first, .count = last - first + 1};
  }
  // What comes after a gap may be on its way.
  std::int64_t count = 0;
  while (first + count <= last && !input.ring.Has(first + count)) ++count;
  return {.first = first, .count = count};
}

}  // namespace fogline
