// Numbers for the channels of a network. Binary frames name a channel by its number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/runtime/wire/wire.h"

namespace fogline::web {

using ChannelId = std::uint16_t;

struct KnownChannel {
  ChannelId id = 0;
  std::string name;
  std::string type;  // "": unknown, because it is not a type of Fogline
};

/// The number of each channel. The number of a channel in kChannels (services/graph.h) is its index
/// there. Other channels get the next numbers in the order of their first messages.
class ChannelTable {
 public:
  /// Limit for the channels that are not in kChannels. It is needed because any program on the
  /// network can invent names.
  static constexpr std::size_t kMostOthers = 4096;

  /// Returns the number of a channel. Adds the channel if it is new.
  /// @param bytes a message of the channel; its first bytes name its type
  /// @return nullopt if the channel is new and there are too many channels
  std::optional<ChannelId> IdOf(std::string_view name, runtime::Bytes bytes);

  /// The channels that are not in kChannels, in the order of their numbers.
  const std::vector<KnownChannel>& others() const { return others_; }

 private:
  std::map<std::string, ChannelId, std::less<>> ids_;
  std::vector<KnownChannel> others_;
};

}  // namespace fogline::web
