// All senders on an LCM network, and what of their messages was lost. The caller passes packets and
// times in.
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

/// Where packets come from: the socket of one LCM instance.
struct SenderAddress {
  std::uint32_t host = 0;  // IPv4
  std::uint16_t port = 0;

  auto operator<=>(const SenderAddress&) const = default;
  std::string ToString() const;
};

struct SenderView {
  std::string address;  // such as "127.0.0.1:41234"
  SenderSequence::Counts counts;
  std::vector<std::string> channels;  // the first ones on which it sent: they tell who it is
  bool more_channels = false;         // it has sent on further channels
  double age_s = 0;                   // since its last packet
};

struct SendersView {
  std::vector<SenderView> senders;  // by address
  std::int64_t forgotten = 0;       // senders that were dropped for lack of room
  std::int64_t not_lcm = 0;         // packets that LCM would not take
  std::int64_t own_overflow = 0;    // packets that this process dropped for lack of room
  std::int64_t in_fragments = 0;    // messages larger than a datagram: Fogline does not take them
  std::vector<std::string> channels_in_fragments;  // the first ones of their channels
};

/// Its memory is bounded for any input: when there is no room, it forgets the sender that has been
/// silent longest.
class Senders {
 public:
  /// @param head the packet, or its first runtime::kPacketHead bytes
  void Add(const SenderAddress& from, runtime::Bytes head, TimePoint now);
  /// Says that this process has dropped packets before the next one. Their sender is unknown.
  void AddDropped(std::int64_t packets) { own_overflow_ += packets; }

  /// The senders that have sent anything besides LCM's own self-test and the beacons of runs.
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
