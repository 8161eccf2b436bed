// The Foxglove WebSocket protocol, version 1, for viewers of other projects such as Foxglove and
// Lichtblick (github.com/foxglove/ws-protocol, docs/spec.md). This file has the session of one
// client without a socket: the caller passes received frames, and sends the returned frames.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/web/foxglove/channels.h"

namespace fogline::web::foxglove {

/// One WebSocket message.
struct Frame {
  bool binary = false;
  std::string bytes;  // UTF-8 if `binary` is false

  bool operator==(const Frame&) const = default;
};

/// The session of one client. A client subscribes to channels, and gets their messages as JSON
/// (DecodeJson()). It cannot send messages, because Fogline's viewers never change a run.
class Session {
 public:
  /// @param channels must outlive the session
  explicit Session(const Channels& channels) : channels_(channels) {}

  /// The frames that the server sends first.
  std::vector<Frame> Opened() const;

  /// The frame that tells the client about a channel that was added after Opened().
  Frame Advertised(const Channel& channel) const;

  struct Answer {
    std::vector<Frame> frames;
    std::string error;  // why the frame is refused; "" if it is not
  };
  /// Handles a frame of the client. If the frame is refused, the answer is a status of level error.
  Answer Received(std::string_view bytes, bool binary);

  /// The frame with a message for the client; nullopt if the client has not subscribed to the
  /// channel, or the bytes are not a message of the channel's type.
  /// @param time_ns when the message was received, in ns since 1970
  /// @param message the bytes without their signature (message_signer.h)
  std::optional<Frame> Message(std::uint32_t channel, std::uint64_t time_ns, Bytes message);

  /// Whether the client has subscribed to any channel. If not, Message() returns nullopt.
  bool Subscribed() const { return !subscriptions_.empty(); }

  /// The number of messages that were not of their channel's type.
  std::int64_t undecodable() const { return undecodable_; }

 private:
  /// Each of these functions returns "" or an error.
  std::string Text(std::string_view text);
  std::string Subscribe(const nlohmann::ordered_json& request);
  std::string Subscribe(std::uint32_t id, std::uint32_t channel);
  std::string Unsubscribe(const nlohmann::ordered_json& request);

  const Channels& channels_;
  std::map<std::uint32_t, std::uint32_t> subscriptions_;  // the subscription's id, by channel
  std::int64_t undecodable_ = 0;
};

}  // namespace fogline::web::foxglove
