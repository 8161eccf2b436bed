// Counts the messages of a sender that arrived and those that were lost, by LCM's own numbers. It
// works for any LCM program, because each LCM instance numbers its messages. The caller passes
// packets and times in.
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/clock.h"
#include "services/runtime/transport/udpm/lcm_packet.h"

namespace fogline::watch {

/// The numbers of one sender, as its packets arrive. Numbers before the first one do not count: an
/// observer that starts later has lost nothing. The numbers have 32 bits and begin again at 0 after
/// the largest one.
class SenderSequence {
 public:
  struct Counts {
    std::int64_t received = 0;     // messages that arrived whole
    std::int64_t lost = 0;         // messages that did not arrive, although a newer one did
    std::int64_t missed_here = 0;  // the same, but this process itself may have dropped them
    std::int64_t late = 0;         // arrived after a newer one; they are not lost any more
    std::int64_t duplicates = 0;   // arrived again
    std::int64_t stray = 0;        // packets with a number that cannot be believed
    std::int64_t restarts = 0;     // times that the sender began to count again

    bool operator==(const Counts&) const = default;
  };

  /// @param dropped how many packets this process had dropped for lack of room when this packet
  /// came
  void Add(const runtime::LcmPacket& packet, std::int64_t dropped, TimePoint now);

  const Counts& counts() const { return counts_; }

  /// A message that is older than the newest one by this many numbers is not remembered.
  static constexpr std::int64_t kWindow = 1024;
  /// A number further ahead than this, or older than the window, counts only when its successor
  /// follows. The rule and the number (MAX_DROPOUT) are from the algorithm for sequence numbers of
  /// RTP (RFC 3550, appendix A.1). If the numbers went ahead, those between were lost. If they went
  /// back, the sender has begun again, and nothing was lost.
  static constexpr std::int64_t kMaxJump = 3000;
  /// If the numbers went ahead further than this, the sender has begun again, too: no sender sends
  /// so many messages of which none arrives.
  static constexpr std::int64_t kMaxLost = 1'000'000;
  /// After this time without a newer message, known numbers mean that the sender has begun again.
  static constexpr Duration kBeginsAgain = milliseconds(1000);
  /// The number of incomplete messages in fragments that are remembered. A sender finishes each
  /// message before the next one, so more are incomplete only if packets were lost.
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
  std::int64_t length_ = 0;      // how many numbers there were since the first one
  std::bitset<kWindow> whole_;   // bit i: message newest_ - i arrived
  std::bitset<kWindow> missed_;  // bit i: message newest_ - i counts as missed_here
  std::vector<Partial> partial_;
  std::optional<runtime::LcmPacket> doubtful_;  // without its channel
  TimePoint progressed_{};                      // when newest_ grew last
  std::int64_t dropped_ = 0;                    // at the last packet
  std::int64_t unexplained_ = 0;  // own drops since the last gap: they may explain the next one
};

}  // namespace fogline::watch
