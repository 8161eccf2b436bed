// Receives the messages of a udpm:// network in the thread of the caller.
//
// LCM receives in a separate thread. For each message this thread wakes up, writes into a pipe, and
// the pipe wakes the caller. A run in lockstep with nine processes on two cores spends most of its
// time on such wake-ups.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/clock.h"
#include "services/runtime/transport/udpm/backlog.h"
#include "services/runtime/transport/udpm/group_socket.h"
#include "services/runtime/transport/udpm/lcm_packet.h"
#include "services/runtime/wire/message_signer.h"

namespace fogline::runtime {

/// A socket that receives messages, for use by one thread.
class MessageSocket {
 public:
  struct Message {
    std::string_view channel;
    Bytes data;
  };

  /// @pre the URL is a udpm:// URL (ParseMulticastUrl)
  /// @param filter attached before the first packet comes
  /// @throws std::system_error if the socket cannot receive the network's packets
  MessageSocket(const std::string& url, std::vector<sock_filter> filter);

  /// From now on, a thread takes the messages out of the kernel's buffer (backlog.h), and fd() is
  /// another descriptor.
  /// @pre keeps_backlog() is false
  /// @throws std::system_error if the kernel grants no thread or no descriptor
  void KeepBacklog();
  bool keeps_backlog() const { return backlog_.has_value(); }

  /// Waits up to `timeout` for a message. Ignores fragments, and messages whose data is longer than
  /// kMaxMessageBytes and a signature together (ChannelFilter() already drops most of these
  /// packets). A signal ends the wait.
  /// @return whether there is a message
  bool Wait(Duration timeout);
  /// The message for which Wait() has returned true. It is valid until the next call of Wait().
  /// @return nullopt if it was taken before
  std::optional<Message> Take() { return std::exchange(message_, std::nullopt); }
  /// The message that Take() would return.
  const std::optional<Message>& message() const { return message_; }

  /// This descriptor is readable when a message may be there.
  int fd() const { return backlog_ ? backlog_->fd() : socket_.fd(); }
  /// The UDP socket.
  int socket() const { return socket_.fd(); }
  bool filtered() const { return socket_.filtered(); }

 private:
  bool Receive();
  std::optional<Bytes> NextPacket();

  static constexpr std::size_t kMostPacket = kPacketHead + kMaxMessageBytes + kSignatureBytes;

  GroupSocket socket_;
  std::optional<Backlog> backlog_;
  std::array<std::uint8_t, kMostPacket> buffer_;
  Backlog::Packet kept_;  // the packet of message_, if it came from the backlog
  std::optional<Message> message_;
};

}  // namespace fogline::runtime
