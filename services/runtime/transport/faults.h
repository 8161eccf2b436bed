// Simulates a bad network on request. Messages that a process receives are lost, doubled, delayed,
// overtaken or damaged before the process reads them. The simulation works on any bus, also on a
// bus in memory. The faults of the n-th message that a role receives depend only on the seed, the
// role and n.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/clock.h"
#include "services/graph.h"
#include "services/runtime/wire/wire.h"

namespace fogline::runtime {

/// The probability of each fault of a message, and the delay of all messages. The faults are
/// independent of each other.
struct FaultRates {
  double loss = 0;
  double duplicate = 0;
  double reorder = 0;   // the message is delayed by 2 ms, so later messages overtake it
  double truncate = 0;  // the message is cut off at a random place
  double flip = 0;      // one bit of the message is wrong
  double delay_ms = 0;  // delay of every message
  std::int64_t seed = 1;

  /// Whether messages may arrive with changed contents. Only a signature detects every change.
  bool Damage() const { return truncate > 0 || flip > 0; }
};

/// Reads a text such as "loss=0.3,delay_ms=5,seed=7", with any members of FaultRates by name.
/// @throws InputError if the text is wrong
FaultRates ParseFaults(std::string_view text);

class Faults {
 public:
  Faults(const FaultRates& rates, Role role) : rates_(rates), role_(role) {}

  /// Takes a message that has come.
  void Take(std::string_view channel, Bytes bytes, TimePoint now);

  struct Message {
    std::string channel;
    std::vector<std::uint8_t> bytes;
  };
  /// The next message whose delivery is due by now; nullopt if there is none.
  std::optional<Message> Due(TimePoint now);
  /// When the next delivery is due; TimePoint::max() if no message waits.
  TimePoint NextDue() const;

 private:
  enum class Draw : std::uint8_t { kLossOrDuplicate, kReorderOrTruncate, kFlip, kPlaces };
  /// Two uniform random numbers in (0, 1) for the message that has just come.
  std::array<double, 2> Uniform2(Draw draw) const;

  FaultRates rates_;
  Role role_;
  std::int64_t count_ = 0;                     // messages taken
  std::multimap<TimePoint, Message> waiting_;  // messages by due time
};

}  // namespace fogline::runtime
