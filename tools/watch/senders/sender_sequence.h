// Counts the messages of a sender that arrived, and those that were lost, by LCM's own numbers.
// This works for any LCM program, because each LCM instance numbers its messages. The class has no
// socket and no clock: the caller passes packets and times as arguments.
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/clock.h"
#include "services/runtime/transport/udpm/lcm_packet.h"

namespace fogline::watch {

/// Follows the numbers of one sender's messages, as its packets arrive. Messages before the first
/// message that the observer has seen do not count as lost, because the observer may have started
/// after the sender. The numbers have 32 bits, and begin again at 0 after the largest one.
class SenderSequence {
 public:
  struct Counts {
    std::int64_t received = 0;     // messages of which all fragments arrived
    std::int64_t lost = 0;         // messages that did not arrive, although a newer one did
    std::int64_t missed_here = 0;  // did not arrive, perhaps because this process dropped them
    std::int64_t late = 0;         // arrived after a newer one; these messages do not count as lost
    std::int64_t duplicates = 0;   // arrived again
    std::int64_t stray = 0;        // packets with an implausible number
    std::int64_t restarts = 0;     // times that the sender's numbers began again

    bool operator==(const Counts&) const = default;
  };

  /// @param dropped number of all packets that this process has dropped so far, for lack of room
  void Add(const runtime::LcmPacket& packet, std::int64_t dropped, TimePoint now);

  const Counts& counts() const { return counts_; }

  /// Number of the newest messages that are remembered.
  static constexpr std::int64_t kWindow = 1024;
  /// Largest distance of a plausible number from the newest one. A number that is further ahead, or
  /// older than the window, counts only when its successor follows. The rule and the number
  /// (MAX_DROPOUT) are from the algorithm for sequence numbers of RTP (RFC 3550, appendix A.1). If
  /// such a number is ahead of the newest number, the messages with the numbers between these two
  /// count as lost. If it is older, the sender has begun its numbers again, and no message counts
  /// as lost.
  static constexpr std::int64_t kMaxJump = 3000;
  /// Largest number of successive messages that can be lost. If the numbers go ahead by more, the
  /// sender has begun again, because no sender sends so many messages of which none arrives.
  static constexpr std::int64_t kMaxLost = 1'000'000;
  /// If a message has a number that has come before, and no newer message has come for this time,
  /// the sender may have begun its numbers again. A message with the next number confirms this.
  static constexpr Duration kBeginsAgain = milliseconds(1000);
  /// Limit for the number of incomplete messages that are remembered. A sender finishes each
  /// message before the next one, so more messages are incomplete only if packets were lost.
  static constexpr std::size_t kMaxPartial = 4;

 private:
  /// A message of which some fragments have arrived.
  struct Partial {
    std::uint32_t number;
    std::uint16_t arrived;
    std::vector<bool> fragments;
  };

  void Begin(const runtime::LcmPacket& packet, TimePoint now);
  void Take(const runtime::LcmPacket& packet, TimePoint now);
  void Advance(const runtime::LcmPacket& packet, std::int64_t ahead, TimePoint now);
  void TakeOlder(const runtime::LcmPacket& packet, std::int64_t age);
  void Doubt(const runtime::LcmPacket& packet, TimePoint now);
  void Miss(std::int64_t count);
  bool IsKnown(std::int64_t age) const;
  /// Whether the packet completes its message.
  bool Completes(const runtime::LcmPacket& packet);
  std::int64_t AgeOf(std::uint32_t number) const;

  Counts counts_;
  bool begun_ = false;
  std::uint32_t newest_ = 0;
  std::int64_t length_ = 0;      // number of messages since the first one
  std::bitset<kWindow> whole_;   // bit i: message newest_ - i arrived
  std::bitset<kWindow> missed_;  // bit i: message newest_ - i counts as missed_here
  std::vector<Partial> partial_;
  std::optional<runtime::LcmPacket> doubtful_;  // waits for its successor; kept without its channel
  TimePoint progressed_{};                      // when newest_ grew last
  std::int64_t dropped_ = 0;                    // value of `dropped` at the last packet
  std::int64_t unexplained_ = 0;  // packets dropped since the last gap; may explain the next gap
};

}  // namespace fogline::watch
