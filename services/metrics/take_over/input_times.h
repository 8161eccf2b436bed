// The times of a person's first movements after each request to take over, from DRIVER_INPUT.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>

#include "fogline/driver_input_t.hpp"
#include "services/metrics/take_over/take_over_measures.h"

namespace fogline::metrics {

/// A pedal has moved if its position differs by at least this share of its travel from the position
/// at the request. Our choice: 1 % is more than two steps of an axis with 8 bits (0.4 % each), so
/// the noise of such an axis does not count as a movement.
inline constexpr double kMovement = 0.01;

/// Fills in first_movement_time_s and pedal_on_time_s of the requests of a run.
///
/// The time of an input is header.utime, the time of the newest TRUTH that the seat had received
/// when the input came. So the resolution is one step of the run. If a person sees the request late
/// because of the network or the screen, the times are longer. An input counts only if it comes
/// after the request, and at most judged_s later (the length of the judged interval).
class InputTimes {
 public:
  /// @param requests the requests of the run in order of time; they must outlive this object
  /// @param pedal travel of throttle or brake that counts as pedal-on (/person/take_over_pedal)
  InputTimes(std::span<TakeOverMeasures> requests, double pedal)
      : requests_(requests), pedal_(pedal) {}

  /// Adds the next input of a seat. The inputs of a seat must come in order.
  /// @pre the driver has used an input of this seat: a DRIVER_COMMAND names the seat's instance
  void Add(const driver_input_t& input);

 private:
  struct Position {
    double throttle = 0;
    double brake = 0;
    bool button = false;  // whether the button for taking over is down
  };
  /// A seat: its last input, and its input at the last request.
  struct Seat {
    Position now;
    Position at_request;
    std::size_t begun = 0;  // number of requests before the last input
  };

  std::span<TakeOverMeasures> requests_;
  double pedal_;
  std::map<std::int64_t, Seat> seats_;  // by driver_input_t.instance
};

}  // namespace fogline::metrics
