// Puts the messages of LCM together from UDP packets. LCM's own library (LCM 1.3.1) is not used
// here: it hides the numbers by which a loss is found, loses a message if its fragments come in
// another order, and delivers a wrong message if a fragment comes twice.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/runtime/transport/udpm/lcm_packet.h"
#include "tools/watch/senders/packet_socket.h"

namespace fogline::record {

/// A message as its sender has sent it.
struct Message {
  std::string_view channel;
  std::int64_t unix_us = 0;  // arrival of its last packet, in us since 1970
  runtime::Bytes data;
};

/// Assembles messages in bounded memory. If there is no room, this class gives up the incomplete
/// message whose first packet came earliest.
class MessageAssembler {
 public:
  /// The data of a UDP packet is smaller than this.
  static constexpr std::size_t kMostPacket = 1 << 16;

  /// @return the message that this packet completes; valid until the next call
  std::optional<Message> Add(const watch::Packet& packet);

  /// Number of messages that were given up, because fragments were missing.
  std::int64_t given_up() const { return given_up_; }

  /// Limits for messages that wait for fragments, as in LCM: 1000 messages, together 16 MiB. A
  /// single message may be larger.
  static constexpr std::size_t kMostPartial = 1000;
  static constexpr std::size_t kMostBytes = 16 << 20;

 private:
  using Key = std::pair<watch::SenderAddress, std::uint32_t>;  // sender, and number of the message
  struct Partial {
    std::string channel;
    std::vector<std::uint8_t> data;
    std::uint32_t size = 0;
    std::vector<bool> arrived;
    std::size_t missing = 0;
    std::int64_t order = 0;  // orders the messages by their first packets
  };

  std::optional<Message> AddFragment(const watch::Packet& packet, const runtime::LcmPacket& head);
  void MakeRoom(const Key& keep);

  std::map<Key, Partial> partial_;
  std::size_t bytes_ = 0;  // bytes of data in partial_
  std::int64_t packets_ = 0;
  std::int64_t given_up_ = 0;
  Partial whole_;  // the last message that was completed
};

}  // namespace fogline::record
