#include "tools/replay/live/recorded_messages.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"

namespace fogline::replay {

RecordedMessages::RecordedMessages(const std::filesystem::path& log,
                                   const log::ReadOptions& options,
                                   std::vector<std::size_t> channels)
    : channels_(std::move(channels)), reader_(log, options) {
  while (const log::StepMessages* messages = reader_.Next()) {
    if (reader_.InTail()) continue;
    messages_.resize(static_cast<std::size_t>(reader_.step()));  // missing steps stay empty
    std::vector<runtime::Bytes>& row = messages_.emplace_back();
    for (const std::size_t channel : channels_) {
      const runtime::Bytes message = (*messages)[channel];
      // Readers would refuse a message of another version of its type. So such a message counts as
      // missing.
      const bool fits = message.size() >= runtime::kHeaderEnd &&
                        runtime::ReadInt64(message, 0) == runtime::FingerprintOf(channel);
      row.push_back(fits ? message : runtime::Bytes());
    }
  }
}

runtime::Bytes RecordedMessages::Of(std::int64_t step, std::size_t channel) const {
  if (step < 0 || step >= steps()) return {};
  const std::vector<runtime::Bytes>& row = messages_[static_cast<std::size_t>(step)];
  return channel < row.size() ? row[channel] : runtime::Bytes();
}

std::string RecordedMessages::FirstGap() const {
  for (std::int64_t step = 0; step < steps(); ++step) {
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      if (!Of(step, i).empty()) continue;
      return fmt::format("step {} lacks {}", step, kChannels[channels_[i]].name);
    }
  }
  return "";
}

std::vector<std::size_t> RecordedChannels(std::string_view names) {
  std::vector<std::string_view> known;
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace == Pace::kStep && channel.from != Role::kWorld) known.push_back(channel.name);
  }
  std::vector<std::size_t> channels;
  for (std::size_t at = 0; at <= names.size();) {
    const std::size_t end = std::min(names.find(',', at), names.size());
    const std::string_view name = names.substr(at, end - at);
    at = end + 1;
    if (std::ranges::find(known, name) == known.end()) {
      throw InputError(fmt::format("error: --channels {}: not one of {}{}", Shown(name),
                                   Shown(Names(known)), DidYouMean(Nearest(name, known))));
    }
    const std::size_t channel = ChannelNamed(name);
    if (std::ranges::find(channels, channel) == channels.end()) channels.push_back(channel);
  }
  return channels;
}

}  // namespace fogline::replay
