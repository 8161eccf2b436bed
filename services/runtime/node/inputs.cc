#include "services/runtime/node/inputs.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <type_traits>

#include <fmt/core.h>

#include "services/runtime/node/fire_rule.h"

namespace fogline::runtime {
namespace {

/// The counter in status_t for the kind of error in the bytes; nullptr if the bytes are a valid
/// message of the channel.
RefusalCounter WrongOn(std::size_t channel, Arrival& arrival) {
  static const auto wrong = std::apply(
      [](const auto&... each) {
        return std::array{&Arrival::Wrong<typename std::decay_t<decltype(each)>::Message>...};
      },
      kGraph);
  return (arrival.*wrong[channel])();
}

}  // namespace

Inputs::Inputs(Bus& bus, Role role, const RunNews& run, OwnStatus& own,
               const std::unique_ptr<FireRule>& rule)
    : bus_(bus), role_(role), run_(run), own_(own), rule_(rule) {
  for (std::size_t i = 0; i < kChannels.size(); ++i) {
    if (kChannels[i].pace != Pace::kStep) continue;
    if (kChannels[i].to.Has(role) || role == Role::kRecorder) Read(i, false);
  }
}

Input& Inputs::Of(std::size_t channel) {
  return *std::ranges::find(inputs_, channel, &Input::channel);
}

Input& Inputs::ReadOnDemand(std::size_t channel) { return Read(channel, true); }

Input& Inputs::Read(std::size_t channel, bool on_demand) {
  const ChannelInfo& info = kChannels[channel];
  inputs_.push_back({.channel = channel,
                     .fingerprint = FingerprintOf(channel),
                     .lag = LagOf(info.from, role_),
                     .on_demand = on_demand,
                     .ring = {}});
  const std::size_t index = inputs_.size() - 1;
  bus_.Subscribe(info.name, [this, index](Arrival& arrival) { OnMessage(index, arrival); });
  return inputs_.back();
}

void Inputs::OnMessage(std::size_t input, Arrival& arrival) {
  if (!own_.Running()) return;
  const Bytes bytes = arrival.bytes();
  if (bytes.size() < kHeaderEnd) return own_.Refuse(&status_t::malformed);
  if (ReadInt64(bytes, 0) != inputs_[input].fingerprint) return own_.Refuse(&status_t::wrong_type);
  if (ReadInt64(bytes, kRunIdOffset) != *run_.id) return own_.Refuse(&status_t::foreign);
  const std::int64_t step = ReadInt64(bytes, kStepOffset);
  if (step < 0 || step >= run_.steps) return own_.Refuse(&status_t::out_of_window);
  rule_->OnInput(input, step, arrival);
}

bool Inputs::Keep(std::size_t index, std::int64_t step, Arrival& arrival,
                  StepRing::Verdict verdict) {
  switch (verdict) {
    case StepRing::Verdict::kDuplicate:
      ++own_.message().duplicates;
      return false;
    case StepRing::Verdict::kOutOfWindow:
      own_.Refuse(&status_t::out_of_window);
      return false;
    case StepRing::Verdict::kElsewhere:
    case StepRing::Verdict::kLate:
      return false;
    case StepRing::Verdict::kConflict:
    case StepRing::Verdict::kNew:
      break;
  }
  Input& input = inputs_[index];
  if (const RefusalCounter wrong = WrongOn(input.channel, arrival)) {
    own_.Refuse(wrong);
    return false;
  }
  if (verdict == StepRing::Verdict::kConflict) {
    own_.Fail(Contradiction(step, kChannels[input.channel]));
    return false;
  }
  if (input.keep) input.keep(step, arrival);
  input.ring.Store(step, arrival.bytes());
  input.heard = arrival.time();
  return true;
}

void Inputs::Remember(std::size_t input, std::int64_t step, Bytes bytes) {
  inputs_[input].ring.Store(step, bytes);
  remembered_ = std::max(remembered_, step + 1);
}

std::string Inputs::Contradiction(std::int64_t step, const ChannelInfo& channel) const {
  if (step >= remembered_) {
    return fmt::format("step {}: {} came twice with different contents: is there a second {}?",
                       step, channel.name, NameOf(channel.from));
  }
  return fmt::format(
      "step {}: {} differs from the log: {} is not the program or version that was "
      "recorded",
      step, channel.name, NameOf(channel.from));
}

}  // namespace fogline::runtime
