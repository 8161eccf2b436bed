#include "services/runtime/realtime/culprit.h"

#include <fmt/core.h>

namespace fogline::runtime {
namespace {

// The first channel of the set; kNumChannels if the set is empty.
std::size_t First(const ChannelSet& set) {
  std::size_t channel = 0;
  while (channel < kNumChannels && !set[channel]) ++channel;
  return channel;
}

}  // namespace

std::optional<Culprit> FindCulprit(const ChannelSet& lost, const LostByRole& reported) {
  std::size_t channel = First(lost);
  if (channel == kNumChannels) return std::nullopt;
  ChannelSet blamed;
  while (true) {
    blamed.set(channel);
    const auto producer = static_cast<std::size_t>(kChannels[channel].from);
    const std::size_t further =
        producer < reported.size() ? First(reported[producer]) : kNumChannels;
    if (further == kNumChannels || blamed[further]) break;
    channel = further;
  }
  return Culprit{kChannels[channel].from, channel};
}

std::string Text(const Culprit& culprit) {
  return fmt::format("{} ({} lost)", NameOf(culprit.role), kChannels[culprit.channel].name);
}

}  // namespace fogline::runtime
