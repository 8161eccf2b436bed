#include "tools/watch/senders/senders.h"

#include <algorithm>

#include <fmt/core.h>

#include "tools/watch/traffic_statistics.h"

namespace fogline::watch {

std::string SenderAddress::ToString() const {
  return fmt::format("{}.{}.{}.{}:{}", host >> 24, host >> 16 & 0xff, host >> 8 & 0xff, host & 0xff,
                     port);
}

void Senders::Add(const SenderAddress& from, runtime::Bytes head, TimePoint now) {
  const auto packet = runtime::ParsePacket(head);
  if (!packet) {
    ++not_lcm_;
    return;
  }
  Record& record = RecordOf(from);
  record.heard = now;
  record.sequence.Add(*packet, own_overflow_, now);
  if (!packet->First() || IsHousekeeping(packet->channel)) return;
  Remember(packet->channel, record);
  if (!packet->Whole()) CountFragmented(packet->channel);
}

void Senders::CountFragmented(std::string_view channel) {
  ++in_fragments_;
  auto& channels = channels_in_fragments_;
  const bool known = std::ranges::find(channels, channel) != channels.end();
  if (!known && channels.size() < kMaxChannels) channels.emplace_back(channel);
}

Senders::Record& Senders::RecordOf(const SenderAddress& from) {
  if (const auto record = records_.find(from); record != records_.end()) return record->second;
  if (records_.size() == kMaxSenders) {
    records_.erase(std::ranges::min_element(
        records_, {}, [](const auto& record) { return record.second.heard; }));
    ++forgotten_;
  }
  return records_[from];
}

void Senders::Remember(std::string_view channel, Record& record) {
  if (std::ranges::find(record.channels, channel) != record.channels.end()) return;
  if (record.channels.size() == kMaxChannels) {
    record.more_channels = true;
  } else {
    record.channels.emplace_back(channel);
  }
}

SendersView Senders::View(TimePoint now) const {
  SendersView view{.senders = {},
                   .forgotten = forgotten_,
                   .not_lcm = not_lcm_,
                   .own_overflow = own_overflow_,
                   .in_fragments = in_fragments_,
                   .channels_in_fragments = channels_in_fragments_};
  for (const auto& [address, record] : records_) {
    if (record.channels.empty()) continue;
    view.senders.push_back({.address = address.ToString(),
                            .counts = record.sequence.counts(),
                            .channels = record.channels,
                            .more_channels = record.more_channels,
                            .age_s = Seconds(now - record.heard)});
  }
  return view;
}

}  // namespace fogline::watch
