// The rules of the seat: which client of the page /drive drives, and which messages the run gets.
// The class has no sockets and reads no clock.
//
// One client has the seat. Each input of this client becomes a DRIVER_INPUT. If no client has the
// seat, or the client with the seat is silent, a DRIVER_INPUT every kInputEvery says that no person
// drives. So a run that gets no DRIVER_INPUT knows that there is a fault.
//
// An open page without a person does not keep the seat from others. If no person is present at the
// client with the seat, the first other client with a person gets the seat.
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
  /// After this time without an input, a page does not drive. A page sends an input every 50 ms, so
  /// six inputs in a row are missing then. This is also the default of /person/deadman_s.
  static constexpr Duration kSilent = milliseconds(300);

  /// @param instance value of DRIVER_INPUT's `instance`; not 0
  explicit Seat(std::int64_t instance);

  /// Takes the header of the newest TRUTH, or the header of a run that has not begun (step -1).
  void Hear(const header_t& header) { message_.header = header; }
  const header_t& header() const { return message_.header; }

  /// Gives the seat to a client if the seat is free. @return whether this client has the seat
  bool Sit(std::uint64_t client, TimePoint now);
  /// Takes the seat from a client that leaves.
  /// @return a message that says that no person drives; nullopt if the client did not have the seat
  std::optional<driver_input_t> Leave(std::uint64_t client, TimePoint now);

  struct Taken {
    std::optional<driver_input_t> message;  // to be sent now
    std::string why;                        // why the input is refused; "" if it is accepted
    bool too_many = false;                  // whether it is refused because of the rate limit
    bool sits = false;                      // whether this input gave the client the seat
    std::optional<std::uint64_t> before;    // the client that had the seat before, if `sits`
  };
  /// Takes an input. An input without a person, from a client without the seat, has no effect.
  Taken Take(std::uint64_t client, const SeatInput& input, TimePoint now);

  /// A message that says that no person drives; nullopt if no such message is due.
  std::optional<driver_input_t> Look(TimePoint now);
  /// The next time at which Look() may return a message.
  TimePoint next_look() const;

  bool Has(std::uint64_t client) const { return client_ == client; }
  std::optional<std::uint64_t> client() const { return client_; }
  /// Whether a client has the seat, but is silent.
  bool lost() const { return client_ && silent_; }

 private:
  driver_input_t Next(TimePoint now);
  /// The next message. It says that no person drives.
  driver_input_t EmptySeat(TimePoint now);

  driver_input_t message_{};  // the last message
  std::int64_t sent_ = 0;     // number of messages
  TimePoint sent_at_{};
  std::optional<std::uint64_t> client_;
  TimePoint heard_at_{};
  bool silent_ = true;
  runtime::RateLimiter limiter_{runtime::kMostInputsPerSecond, runtime::kMostInputsAtOnce};
};

}  // namespace fogline::web
