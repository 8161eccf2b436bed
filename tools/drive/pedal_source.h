// A device with pedals and buttons, as a seat reads it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/clock.h"
#include "fogline/driver_input_t.hpp"

namespace fogline::drive {

/// The state of a device.
struct PedalState {
  bool present = true;
  double throttle = 0;  // in [0, 1]
  double brake = 0;
  std::vector<double> axes;  // raw values in [-1, 1]
  std::int32_t buttons = 0;  // bits of driver_input_t
  TimePoint at{};            // the time of the newest input of the device

  /// Whether all members except `at` are equal.
  bool SameAs(const PedalState& other) const {
    return present == other.present && throttle == other.throttle && brake == other.brake &&
           axes == other.axes && buttons == other.buttons;
  }
};

class PedalSource {
 public:
  virtual ~PedalSource() = default;
  PedalSource(const PedalSource&) = delete;
  PedalSource& operator=(const PedalSource&) = delete;

  /// Reads, without waiting, all inputs that have come from the device. Returns the state after
  /// these inputs.
  virtual PedalState Read(TimePoint now) = 0;
  /// A file descriptor that is readable when the device has new inputs; -1 if the device is not
  /// open.
  virtual int fd() const = 0;
  virtual std::int8_t kind() const = 0;
  virtual std::string name() const = 0;

 protected:
  PedalSource() = default;
};

}  // namespace fogline::drive
