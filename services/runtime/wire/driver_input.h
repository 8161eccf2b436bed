// The limits of the contents of a DRIVER_INPUT, and of the rate at which a seat may send it. All
// programs that send or read DRIVER_INPUT use these limits.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "common/clock.h"
#include "services/runtime/wire/refusals.h"

namespace fogline::runtime {

/// The longest time between two messages of a seat. A longer silence is a fault.
inline constexpr Duration kInputEvery = milliseconds(50);
/// A seat sends at most this many messages in a second. Our choice: the fastest gamepads report 250
/// times a second over Bluetooth.
inline constexpr double kMostInputsPerSecond = 250;
/// The number of messages of a seat that may come in one burst. After a stop of 0.2 s, a network
/// delivers this many messages together.
inline constexpr double kMostInputsAtOnce = 50;
/// Longest name of a device, in bytes of UTF-8.
inline constexpr std::size_t kMostDeviceBytes = 64;
/// The largest number of axes. No usual gamepad or wheel has more axes.
inline constexpr std::int32_t kMostAxes = 16;

/// Checks whether every number of the message is in its range, and whether the name of the device
/// has at most kMostDeviceBytes.
/// @return nullptr if nothing is wrong; otherwise the counter for the refusal
inline RefusalCounter WrongIn(const driver_input_t& input) {
  const auto in = [](double value, double least, double most) {
    return value >= least && value <= most;  // false for NaN
  };
  constexpr std::int32_t kTakeOver = driver_input_t::TAKE_OVER;
  constexpr std::int32_t kGiveBack = driver_input_t::GIVE_BACK;
  const bool sound =
      input.header.step >= -1 && input.instance != 0 && input.sequence >= 0 &&
      input.latency_us >= -1 && input.device_kind >= driver_input_t::KEYBOARD &&
      input.device_kind <= driver_input_t::EVDEV && input.device.size() <= kMostDeviceBytes &&
      in(input.throttle, 0, 1) && in(input.brake, 0, 1) && input.num_axes <= kMostAxes &&
      std::ranges::all_of(input.axes, [&](double axis) { return in(axis, -1, 1); }) &&
      (input.buttons & ~(kTakeOver | kGiveBack)) == 0;
  return sound ? nullptr : &status_t::out_of_range;
}

}  // namespace fogline::runtime
