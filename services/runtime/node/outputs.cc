#include "services/runtime/node/outputs.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/core.h>

namespace fogline::runtime {
namespace {

// All roles receive each answer. If another request for the same step comes within this time after
// an answer, it gets no answer. The role that asks has received the first answer, or will ask
// again.
constexpr Duration kAnswerHolds = milliseconds(1);
// Answers with the newest kNewest steps do not count for the rate limit, because the run waits for
// these steps.
constexpr std::int64_t kNewest = 2;

/// The requests that a role can answer: requests for its own channels. The recorder can answer
/// requests for all channels.
Contents RequestsTo(Role role) {
  Contents requests{.offset = kHeaderEnd, .texts = {}};
  if (role == Role::kRecorder) return requests;
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace == Pace::kStep && channel.from == role) {
      requests.texts.push_back(EncodedText(channel.name));
    }
  }
  return requests;
}

}  // namespace

Outputs::Outputs(Parts& parts, Role role, Work& work, const std::unique_ptr<FireRule>& rule)
    : parts_(parts), work_(work), rule_(rule) {
  for (std::size_t i = 0; i < kChannels.size(); ++i) {
    if (kChannels[i].pace != Pace::kStep || kChannels[i].from != role) continue;
    outputs_.push_back({.channel = i, .topic = parts_.bus.TopicOf(kChannels[i].name), .ring = {}});
  }
  parts_.bus.Subscribe(
      ChannelOf<resend_t>().name, [this](Bytes bytes) { OnResend(bytes); }, RequestsTo(role));
}

void Outputs::Publish(std::size_t channel, std::int64_t step, Bytes bytes) {
  const std::string_view name = kChannels[channel].name;
  if (bytes.size() > kMaxMessageBytes) {
    throw std::runtime_error(fmt::format("step {}: {} takes {} bytes, at most {} fit", step, name,
                                         bytes.size(), kMaxMessageBytes));
  }
  for (Output& output : outputs_) {
    if (output.channel != channel) continue;
    output.ring.Store(step, bytes);
    output.answered[RingSlot(step)] = {};
    // In lockstep, the output of a step that is at least 2 * kMaxAhead steps behind the run is not
    // published. The recorder has this step on disk, and answers requests for it. In real time
    // every output is published.
    if (parts_.run.realtime || step > parts_.run.progress - 2 * kMaxAhead) {
      parts_.bus.Publish(output.topic, bytes);
    }
  }
}

void Outputs::OnResend(Bytes bytes) {
  const TimePoint now = Clock::now();
  if (const auto share = requests_.Count(now)) {
    parts_.bus.SetSampleRate(ChannelOf<resend_t>().name, *share);
  }
  OwnStatus& own = parts_.own;
  resend_t resend{};
  if (const RefusalCounter wrong = Examine(bytes, resend)) return own.Refuse(wrong);
  if (parts_.run.id && resend.header.run_id != *parts_.run.id) {
    return own.Refuse(&status_t::foreign);
  }
  const std::int64_t step = resend.header.step;
  if (step < 0 || step > kMaxStep) return own.Refuse(&status_t::out_of_window);
  if (!own.Running()) return;
  if (resend.channel == ChannelOf<status_t>().name) {
    if (limiter_.Take(now)) work_.OnStatusAsked(step);
    return;
  }
  const StepRange steps{.first = step,
                        .count = std::clamp<std::int64_t>(resend.count, 1, kRingSteps)};
  for (Output& output : outputs_) {
    if (kChannels[output.channel].name != resend.channel) continue;
    AnswerFrom(output, steps, now);
    if (step >= parts_.steps.next()) rule_->OnAskedAhead(step, now);
  }
  work_.OnAsked(resend.channel, steps, now);
}

void Outputs::AnswerFrom(Output& output, StepRange steps, TimePoint now) {
  for (std::int64_t step = steps.first; step < steps.first + steps.count; ++step) {
    TimePoint& answered = output.answered[RingSlot(step)];
    if (!output.ring.Has(step) || now - answered < kAnswerHolds) continue;
    if (step < parts_.steps.next() - kNewest && !limiter_.Take(now)) continue;
    answered = now;
    parts_.bus.Publish(output.topic, output.ring.Get(step));
    ++parts_.own.message().repairs_served;
  }
}

}  // namespace fogline::runtime
