#include "tools/web/channel_table.h"

#include "services/graph.h"
#include "tools/web/types/lcm_types.h"

namespace fogline::web {

std::optional<ChannelId> ChannelTable::IdOf(std::string_view name, runtime::Bytes bytes) {
  if (const std::size_t place = ChannelNamed(name); place < kNumChannels) {
    return static_cast<ChannelId>(place);
  }
  if (const auto known = ids_.find(name); known != ids_.end()) return known->second;
  if (others_.size() == kMostOthers) return std::nullopt;
  const auto id = static_cast<ChannelId>(kNumChannels + others_.size());
  const LcmStruct* type = FoglineTypes().TypeOf(bytes);
  others_.push_back({.id = id, .name = std::string(name), .type = type ? type->name : ""});
  ids_.emplace(name, id);
  return id;
}

}  // namespace fogline::web
