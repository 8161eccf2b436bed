#include "services/recorder/recorder.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "scenario/loader.h"
#include "services/recorder/record_rule.h"

namespace fogline {
namespace {

// Steps between two acknowledgements; a few of them fit into the world's kMaxAhead.
constexpr std::int64_t kAcknowledgeEvery = kMaxAhead / 4;
// Messages that it hands out again per second, and at once: a fifth of a processor. Every role that
// starts again asks for its inputs of 63 steps at a time, one that has six for 378 messages.
constexpr double kAnswersPerSecond = 30'000;
constexpr double kAnswersAtOnce = 3'000;
// Who asks within this time after an answer has it.
constexpr Duration kAnswerHolds = milliseconds(2);
// The runner cannot ask a recorder that has left. With a third of all messages lost one of so many
// arrives, but for one time in 700.
constexpr int kLastWords = 6;

}  // namespace

Recorder::Recorder(Bus& bus, std::optional<std::int64_t> run_id, const std::filesystem::path& file,
                   Existing existing)
    : Node(bus, Role::kRecorder, run_id), file_(file), existing_(existing) {
  budget_ = AnswerBudget(kAnswersPerSecond, kAnswersAtOnce);
  if (existing_ == Existing::kReplace) log_.emplace(file);
}

void Recorder::Configure(const Scenario& scenario) {
  if (existing_ == Existing::kReplace || !Resume()) WriteScenario();
  history_->Reserve(scenario.steps);
  step_us_ = std::llround(scenario.step_s * 1e6);
}

std::unique_ptr<FireRule> Recorder::MakeRule(const Scenario& scenario) {
  if (!realtime()) return Node::MakeRule(scenario);
  auto rule = std::make_unique<RecordRule>(*this, scenario, pace(), run_id());
  recording_ = rule.get();
  return rule;
}

bool Recorder::Resume() {
  const std::optional<Remains> remains = ReadRemains(file_, run_id(), parts().hash());
  const auto steps = remains ? static_cast<std::int64_t>(remains->ends.size()) : 0;
  // The world has begun a step only after the one kMaxAhead before it was on disk.
  // In real time it waits for nobody, and what is missing is a hole.
  if (!realtime() && steps <= progress() - kMaxAhead) {
    throw InputError(fmt::format("{}: the log has {} steps, but {} were in it", file_.string(),
                                 steps, progress() - kMaxAhead + 1));
  }
  if (!remains) {
    log_.emplace(file_);
    return false;
  }
  log_.emplace(file_, remains->head);
  history_.emplace(file_, remains->begin);
  for (const std::int64_t end : remains->ends) history_->Add(end);
  if (remains->final) final_ = steps - 1;
  StartAt(steps);
  return true;
}

void Recorder::WriteScenario() {
  std::vector<std::uint8_t> buffer;
  for (std::size_t i = 0; i < parts().parts().size(); ++i) {
    run_t run = MakeRunPart(run_id(), run_t::PREPARE, 0, parts().hash(), parts().parts(), i);
    if (realtime()) {
      run.realtime = 1;
      run.pace = pace();
    }
    Encode(run, buffer);
    log_->Write(ChannelOf<run_t>().name, 0, buffer);
  }
  log_->Flush();
  history_.emplace(file_, log_->size());
}

RefusalCounter Recorder::Wrong(std::size_t input, Arrival& arrival) {
  RefusalCounter wrong = nullptr;
  ForEachStepChannel([&]<class M>(std::size_t channel) {
    if (channel == inputs()[input].channel) wrong = arrival.Wrong<M>();
  });
  return wrong;
}

RefusalCounter Recorder::Accept(std::size_t input, std::int64_t step, Arrival& arrival) {
  RefusalCounter wrong = nullptr;
  ForEachStepChannel([&]<class M>(std::size_t channel) {
    if (channel != inputs()[input].channel) return;
    const M* message = arrival.As<M>();
    if (message == nullptr) wrong = arrival.Wrong<M>();
    if constexpr (std::is_same_v<M, truth_t>) {
      if (message != nullptr && message->last) final_ = step;
    }
  });
  return wrong;
}

void Recorder::Write(std::int64_t step) {
  for (const Input& input : inputs()) {
    if (!input.ring.Has(step)) continue;
    const Bytes bytes = input.ring.Get(step);
    constexpr std::size_t kTimeOffset = kStepOffset + 8;
    log_->Write(kChannels[input.channel].name, ReadInt64(bytes, kTimeOffset), bytes);
  }
}

void Recorder::WriteStatus(std::int64_t step) {
  recording_->TakeStatus(
      step, [&](Bytes bytes) { log_->Write(ChannelOf<status_t>().name, step * step_us_, bytes); });
}

void Recorder::Compute(std::int64_t step) {
  Write(step);
  if (recording_ != nullptr) WriteStatus(step);
  history_->Add(log_->size());
  // In real time there is time for it, and nobody sends again what a killed process had in hand.
  if (recording_ != nullptr) log_->Flush();
  const bool last = step == final_;
  if (last || (step + 1) % kAcknowledgeEvery == 0) {
    status().header.step = step;
    PublishStatus();
  }
}

void Recorder::OnStatusAsked(std::int64_t step, TimePoint /*now*/) {
  rule().Expect(std::min(step, next() + kRingSteps - 1));
  if (next() > step) PublishStatus();
}

void Recorder::OnAsked(std::string_view channel, StepRange steps, TimePoint now) {
  if (recording_ != nullptr) return AnswerRecent(channel, steps, now);
  // Newer ones are in the ring of their producer. All that is kMaxAhead old is acknowledged, so it
  // can be read.
  static_assert(kAcknowledgeEvery <= kMaxAhead);
  steps.count = std::min(steps.count, next() - kMaxAhead - steps.first);
  for (std::int64_t k = steps.first; k < steps.first + steps.count; ++k) {
    AnswerStep(channel, k, now);
  }
}

void Recorder::AnswerStep(std::string_view channel, std::int64_t step, TimePoint now) {
  const auto input = std::ranges::find_if(
      inputs(), [channel](const Input& one) { return kChannels[one.channel].name == channel; });
  // Reading is work, too: none of it for nothing.
  if (input == inputs().end() || !budget_.Has(now)) return;
  Answered& last = answered_[input->channel][RingSlot(step)];
  if (last.step == step && now - last.at < kAnswerHolds) return;
  last = {.step = step, .at = now};
  history_->ForEach(channel, {.first = step, .count = 1},
                    [&](Bytes bytes) { Answer(channel, bytes, now); });
}

// In real time nobody computes old steps again. A world that has been started again wants to know
// where the cars are: it is the only one that asks for TRUTH, and its producer is dead.
void Recorder::AnswerRecent(std::string_view channel, StepRange steps, TimePoint now) {
  if (channel != ChannelOf<truth_t>().name || !budget_.Has(now)) return;
  const auto truth = std::ranges::find(inputs(), IndexOf<truth_t>(), &Input::channel);
  bool answered = false;
  for (std::int64_t step = steps.first; step < steps.first + steps.count; ++step) {
    if (!truth->ring.Has(step)) continue;
    Answer(channel, truth->ring.Get(step), now);
    answered = true;
  }
  // It may have been started again itself.
  if (answered || history_->steps() == 0) return;
  log_->Flush();
  AnswerStep(channel, history_->steps() - 1, now);
}

void Recorder::BeforeStatus() {
  // STATUS acknowledges every step up to its own: they must be out of this process by then.
  if (!log_ || state() == status_t::FAILED) return;
  try {
    log_->Flush();
  } catch (const std::exception& error) {
    Fail(error.what());
  }
  TellWritten();
}

void Recorder::TellWritten() {
  if (!log_) return;  // it has failed, and has left
  status().log_bytes = log_->written().bytes;
  status().log_checksum = log_->written().checksum;
}

void Recorder::OnLeave() {
  // A run that ends before its last step leaves incomplete steps; what is there is kept.
  if (!log_) return;
  std::int64_t newest = -1;
  for (const Input& input : inputs()) newest = std::max(newest, input.ring.newest());
  try {
    for (std::int64_t step = next(); step <= newest; ++step) Write(step);
    if (recording_ != nullptr) WriteStatus(std::max(newest, next() - 1));
    log_->Flush();
  } catch (const std::runtime_error&) {
    // The disk is full. If that matters to the run it has been said; these steps do not.
  }
  TellWritten();
  log_.reset();
  for (int i = 0; i < kLastWords; ++i) PublishStatus();
}

}  // namespace fogline
