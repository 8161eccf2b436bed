// The rules of the seat at the page: which client drives, and which messages the run gets. The
// class has no sockets and reads no clock.
//
// One client has the seat. Each of its inputs becomes a DRIVER_INPUT. While no client has the seat,
// or the client that has it is silent, the run is told every kInputEvery that no person drives. So
// a run that hears nothing knows that something is wrong.
//
// A page that is only open does not keep the seat: while no person is present at the client that
// has it, the first other client with a person gets it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/clock.h"
#include "fogline/driver_input_t.hpp"
#include "services/runtime/node/rate_limiter.h"
#include "services/runtime/wire/driver_input.h"
#include "tools/web/seat/seat_frame.h"

namespace fogline::web {

class Seat {
 public:
  /// A page that has been silent for so long drives no more. A page sends every 50 ms, so six
  /// frames in a row are then missing. It is also the default of /person/deadman_s.
  static constexpr Duration kSilent = milliseconds(300);

  /// @param instance of DRIVER_INPUT; not 0
  explicit Seat(std::int64_t instance);

  /// The header of the newest TRUTH, or of a run that has not begun (step -1).
  void Hear(const header_t& header) { message_.header = header; }
  const header_t& header() const { return message_.header; }

  /// A client wants to drive. @return whether it has the seat now; otherwise another one has it
  bool Sit(std::uint64_t client, TimePoint now);
  /// A client leaves. @return the message that no person drives any more, if it had the seat
  std::optional<driver_input_t> Leave(std::uint64_t client, TimePoint now);

  struct Taken {
    std::optional<driver_input_t> message;  // to be sent now
    std::string why;                        // why the input is refused; "" if it is not
    bool sits = false;                      // the client has got the seat by this input
    std::optional<std::uint64_t> before;    // the client that had the seat before, if it `sits`
  };
  /// An input without a person, from a client that does not have the seat, has no effect.
  Taken Take(std::uint64_t client, const SeatInput& input, TimePoint now);

  /// The message that is due because no person drives, if one is due.
  std::optional<driver_input_t> Look(TimePoint now);
  /// The next time at which Look() may have a message.
  TimePoint next_look() const;

  bool Has(std::uint64_t client) const { return client_ == client; }
  std::optional<std::uint64_t> client() const { return client_; }
  /// Whether a client has the seat, but is silent.
  bool lost() const { return client_ && silent_; }

 private:
  driver_input_t Next(TimePoint now);
  /// The next message, which says that no person drives.
  driver_input_t EmptySeat(TimePoint now);

  driver_input_t message_{};  // the last one
  std::int64_t sent_ = 0;     // messages
  TimePoint sent_at_{};
  std::optional<std::uint64_t> client_;
  TimePoint heard_at_{};
  bool silent_ = true;
  runtime::RateLimiter limiter_{runtime::kMostInputsPerSecond, runtime::kMostInputsAtOnce};
};

}  // namespace fogline::web
