// The channels that a Foxglove client can choose from.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "tools/web/types/lcm_types.h"

namespace fogline::web::foxglove {

struct Channel {
  std::uint32_t id = 0;
  std::string topic;                // the name of the LCM channel
  const LcmStruct* type = nullptr;  // of its messages
};

/// All sessions of a server share one object. Channels are only added, so ids keep their meaning.
class Channels {
 public:
  /// @param types must outlive this object
  explicit Channels(const LcmTypes& types) : types_(types) {}

  /// Adds a channel whose type is known. A channel of an unknown type cannot be decoded, so a
  /// client could do nothing with it. @pre no other channel has this id
  const Channel& Add(Channel channel);

  /// The channel with this id; nullptr if there is none. The pointer stays valid.
  const Channel* Find(std::uint32_t id) const;

  const std::deque<Channel>& all() const { return channels_; }
  const LcmTypes& types() const { return types_; }

 private:
  const LcmTypes& types_;
  std::deque<Channel> channels_;  // stable addresses
};

}  // namespace fogline::web::foxglove
