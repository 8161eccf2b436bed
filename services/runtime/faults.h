// A bad network on request: what a process receives is lost, doubled, late, overtaken or damaged
// before it is looked at. Any bus has it, in memory too. Seeded: what befalls the n-th message that
// a role receives depends on the seed, the role and n, and on nothing else.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/graph.h"
#include "services/runtime/clock.h"
#include "services/runtime/wire.h"

namespace fogline {

/// How bad the network is: for each message the chance of each mishap, independently.
struct FaultRates {
  double loss = 0;
  double duplicate = 0;
  double reorder = 0;   // held back for 2 ms, so that later messages overtake it
  double truncate = 0;  // cut off somewhere
  double flip = 0;      // one bit of it is wrong
  double delay_ms = 0;  // of every message
  std::int64_t seed = 1;

  /// Whether messages may arrive with other contents: only a signature finds that out.
  bool Damage() const { return truncate > 0 || flip > 0; }
};

/// "loss=0.3,delay_ms=5,seed=7": any of the members of FaultRates by name. @throws InputError
FaultRates ParseFaults(std::string_view text);

class Faults {
 public:
  Faults(const FaultRates& rates, Role role) : rates_(rates), role_(role) {}

  /// A message has come.
  void Take(std::string_view channel, Bytes bytes, TimePoint now);

  struct Message {
    std::string channel;
    std::vector<std::uint8_t> bytes;
  };
  /// The next message that the receiver is to get by now.
  std::optional<Message> Due(TimePoint now);
  /// When that is; the end of time if none is on its way.
  TimePoint NextDue() const;

 private:
  enum class Draw : std::uint8_t { kLossOrDuplicate, kReorderOrTruncate, kFlip, kPlaces };
  /// Two uniform random numbers for the message that has just come.
  std::array<double, 2> Uniform2(Draw draw) const;

  FaultRates rates_;
  Role role_;
  std::int64_t count_ = 0;                     // messages taken
  std::multimap<TimePoint, Message> waiting_;  // by the time when they are due
};

}  // namespace fogline
