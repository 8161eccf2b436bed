// All senders on an LCM network, and how many of their messages were lost. The classes have no
// socket and no clock: the caller passes packets and times as arguments.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/clock.h"
#include "services/runtime/wire/wire.h"
#include "tools/watch/senders/sender_sequence.h"

namespace fogline::watch {

/// The origin of packets: the socket of one LCM instance.
struct SenderAddress {
  std::uint32_t host = 0;  // IPv4
  std::uint16_t port = 0;

  auto operator<=>(const SenderAddress&) const = default;
  std::string ToString() const;
};

struct SenderView {
  std::string address;  // such as "127.0.0.1:41234"
  SenderSequence::Counts counts;
  std::vector<std::string> channels;  // first channels on which it sent; they identify the program
  bool more_channels = false;         // whether it has sent on further channels
  double age_s = 0;                   // time since its last packet
};

struct SendersView {
  std::vector<SenderView> senders;  // by address
  std::int64_t forgotten = 0;       // senders that were dropped for lack of room
  std::int64_t not_lcm = 0;         // packets that are not LCM's
  std::int64_t own_overflow = 0;    // packets that this process dropped for lack of room
  std::int64_t in_fragments = 0;    // messages larger than a datagram, which Fogline refuses
  std::vector<std::string> channels_in_fragments;  // the first channels with such messages
};

/// Counts the messages of all senders. The memory is bounded for any input: if there is no room,
/// the sender that has been silent longest is forgotten.
class Senders {
 public:
  /// @param head the packet, or its first runtime::kPacketHead bytes
  void Add(const SenderAddress& from, runtime::Bytes head, TimePoint now);
  /// Counts packets that this process has dropped before the next packet. Their sender is unknown.
  void AddDropped(std::int64_t packets) { own_overflow_ += packets; }

  /// The senders that have sent on a channel for which IsHousekeeping() is false.
  SendersView View(TimePoint now) const;

  static constexpr std::size_t kMaxSenders = 256;
  static constexpr std::size_t kMaxChannels = 6;

 private:
  struct Record {
    SenderSequence sequence;
    std::vector<std::string> channels;
    bool more_channels = false;
    TimePoint heard{};
  };

  Record& RecordOf(const SenderAddress& from);
  static void Remember(std::string_view channel, Record& record);
  void CountFragmented(std::string_view channel);

  std::map<SenderAddress, Record> records_;
  std::int64_t forgotten_ = 0;
  std::int64_t not_lcm_ = 0;
  std::int64_t own_overflow_ = 0;
  std::int64_t in_fragments_ = 0;
  std::vector<std::string> channels_in_fragments_;
};

}  // namespace fogline::watch
