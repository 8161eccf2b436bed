#include "tools/web/foxglove/channels.h"

#include <algorithm>
#include <utility>

namespace fogline::web::foxglove {

const Channel& Channels::Add(Channel channel) { return channels_.emplace_back(std::move(channel)); }

const Channel* Channels::Find(std::uint32_t id) const {
  const auto channel = std::ranges::find(channels_, id, &Channel::id);
  return channel == channels_.end() ? nullptr : &*channel;
}

}  // namespace fogline::web::foxglove
