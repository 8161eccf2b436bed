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
  const LcmStruct* type = nullptr;  // type of its messages
};

/// The channels of a server, which all its sessions share. No channel is removed, so ids stay
/// valid.
class Channels {
 public:
  /// @param types must outlive this object
  explicit Channels(const LcmTypes& types) : types_(types) {}

  /// Adds a channel whose type is known. Channels of unknown types are not added, because a client
  /// could not decode their messages. @pre no other channel has this id
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
