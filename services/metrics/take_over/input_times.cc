#include "services/metrics/take_over/input_times.h"

#include <algorithm>
#include <cmath>

#include "services/graph.h"
#include "services/metrics/running.h"

namespace fogline::metrics {

void InputTimes::Add(const driver_input_t& input) {
  const double time_s = static_cast<double>(input.header.utime) / kMicrosPerSecond;
  Seat& seat = seats_[input.instance];
  // An input with the same time as the request comes from a person who has not seen the request. So
  // it counts as an input before the request.
  while (seat.begun < requests_.size() &&
         requests_[seat.begun].requested_s + kSameTime_s < time_s) {
    ++seat.begun;
    seat.at_request = seat.now;
  }
  seat.now = {};
  if (input.present == 0) return;
  seat.now = {.throttle = input.throttle,
              .brake = input.brake,
              .button = (input.buttons & driver_input_t::TAKE_OVER) != 0};
  if (seat.begun == 0) return;
  TakeOverMeasures& request = requests_[seat.begun - 1];
  const double since_s = time_s - request.requested_s;
  if (since_s > *request.judged_s + kSameTime_s) return;
  const Position& before = seat.at_request;
  const bool moved = std::abs(seat.now.throttle - before.throttle) >= kMovement ||
                     std::abs(seat.now.brake - before.brake) >= kMovement ||
                     (seat.now.button && !before.button);
  if (moved) Lower(request.first_movement_time_s, since_s);
  if (std::max(seat.now.throttle, seat.now.brake) >= pedal_) {
    Lower(request.pedal_on_time_s, since_s);
  }
}

}  // namespace fogline::metrics
