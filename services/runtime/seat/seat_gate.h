// Decides which DRIVER_INPUT messages are used. Only one seat drives at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "common/clock.h"
#include "services/runtime/node/rate_limiter.h"
#include "services/runtime/wire/driver_input.h"

namespace fogline::runtime {

/// Only the messages of the seat that drives are used. A seat drives while its newest message is
/// less than `deadman` old and says that a person is present. In this time the messages of other
/// seats are refused. When this seat is silent, or its person has left, the next seat whose message
/// says that a person is present drives.
///
/// The class reads no clock: its caller passes the time.
class SeatGate {
 public:
  explicit SeatGate(Duration deadman) : deadman_(deadman) {}

  /// Takes a decoded message of this run.
  /// @return why the message is refused; nullptr if it is not refused. If no other seat drives, a
  ///     late or repeated message is not refused, but has no effect.
  RefusalCounter Take(const driver_input_t& input, TimePoint now) {
    if (const RefusalCounter wrong = WrongIn(input)) return wrong;
    const bool is_new = IsNew(input);
    const bool same = newest_ && newest_->instance == input.instance;
    if (!same && Newest(now) != nullptr) return &status_t::second_seat;
    if (!is_new || (same ? input.sequence <= newest_->sequence : !input.present)) return nullptr;
    if (!limiter_.Take(now)) return &status_t::too_frequent;
    newest_ = input;
    heard_ = now;
    return nullptr;
  }

  /// The newest message of the seat that drives; nullptr if no seat drives. The pointer is valid
  /// until the next Take().
  const driver_input_t* Newest(TimePoint now) const {
    const bool there = newest_ && newest_->present != 0 && now - heard_ < deadman_;
    return there ? &*newest_ : nullptr;
  }

 private:
  /// The newest message of a seat.
  struct Heard {
    std::int64_t instance;
    std::int64_t sequence;
  };
  /// The largest number of seats whose newest messages are remembered. Our choice: an experiment
  /// starts only a few seats.
  static constexpr std::size_t kMostSeats = 64;

  /// Whether the message is newer than all messages of its seat that came before. Otherwise the
  /// message is late or a repetition.
  bool IsNew(const driver_input_t& input) {
    const auto heard = std::ranges::find(seats_, input.instance, &Heard::instance);
    if (heard == seats_.end()) {
      if (seats_.size() == kMostSeats) seats_.pop_front();
      seats_.push_back({input.instance, input.sequence});
      return true;
    }
    if (input.sequence <= heard->sequence) return false;
    heard->sequence = input.sequence;
    return true;
  }

  Duration deadman_;
  std::deque<Heard> seats_;
  RateLimiter limiter_{kMostInputsPerSecond, kMostInputsAtOnce};
  std::optional<driver_input_t> newest_;
  TimePoint heard_{};  // when newest_ came
};

}  // namespace fogline::runtime
