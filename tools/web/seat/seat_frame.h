// An input of the page /drive, read from a text frame (fogline.drive.v1 in docs/view.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fogline::web {

/// An input of the person at the page. Every number is in the range of DRIVER_INPUT.
struct SeatInput {
  std::int64_t sequence = 0;  // number that the page gives to the input
  double age_ms = 0;          // time since the newest input of the device
  bool present = false;       // false: no person drives
  double throttle = 0;        // [0, 1]
  double brake = 0;           // [0, 1]
  std::vector<double> axes;   // of the device, in [-1, 1]
  std::int32_t buttons = 0;   // bits of driver_input_t
  std::int8_t device_kind = 0;
  std::string device;
  std::optional<double> latency_ms;  // a measured latency that no earlier input has reported
};

/// A frame that is refused, with the reason for its sender and for stderr.
struct BadSeatFrame {
  std::string why;
};

using SeatFrame = std::variant<SeatInput, BadSeatFrame>;

/// The longest time in ms that a page may report: an hour. For a longer time a page reports an
/// hour.
inline constexpr double kMostSeatTime_ms = 3'600'000;

/// Reads a frame. Never throws: a wrong text becomes a BadSeatFrame.
SeatFrame ParseSeatFrame(std::string_view text);

}  // namespace fogline::web
