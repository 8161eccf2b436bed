// Finds the pedals among the axes of a device, and converts the axes' values.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fogline::drive {

/// The range of an axis, as the kernel states it.
struct AxisRange {
  int least = 0;
  int most = 0;
};

/// The size of the dead zone at each end of an axis, as a share of the axis. In a dead zone the
/// pedal counts as fully released or as fully pressed. The value is our choice: potentiometers of
/// pedals rest within about 1 % of their ends, and a person does not feel 3 % of a pedal's travel.
inline constexpr double kDeadZone = 0.03;

/// A pedal: an axis, and its direction.
struct PedalAxis {
  int code = -1;          // ABS_...
  bool inverted = false;  // whether the value is largest when the pedal is released

  /// The travel of the pedal at this value of the axis: from 0 (released) to 1 (fully pressed).
  double Travel(int value, const AxisRange& range) const {
    if (range.most <= range.least) return 0;
    const double span = static_cast<double>(range.most) - range.least;
    const double share = (static_cast<double>(value) - range.least) / span;
    const double travel = inverted ? 1 - share : share;
    return std::clamp((travel - kDeadZone) / (1 - 2 * kDeadZone), 0.0, 1.0);
  }
};

/// The raw value of an axis, scaled to [-1, 1].
inline double Scaled(int value, const AxisRange& range) {
  if (range.most <= range.least) return 0;
  const double span = static_cast<double>(range.most) - range.least;
  return std::clamp(2 * (static_cast<double>(value) - range.least) / span - 1, -1.0, 1.0);
}

/// The axes and keys of a device.
struct DeviceFeatures {
  bool gas_and_brake = false;  // ABS_GAS and ABS_BRAKE
  bool triggers = false;       // ABS_Z and ABS_RZ
  bool is_gamepad = false;     // BTN_GAMEPAD
  bool arrow_keys = false;     // KEY_UP and KEY_DOWN
};

/// The axes and buttons that the user has named. "" stands for the usual axis or button
/// (UsualMap()).
struct DeviceNames {
  std::string throttle;
  std::string brake;
  std::string take_over;
  std::string give_back;
};

/// The use of a device's axes and keys. Without a throttle axis, the arrow keys up and down are the
/// pedals.
struct DeviceMap {
  std::optional<PedalAxis> throttle;
  std::optional<PedalAxis> brake;
  int take_over = -1;  // BTN_... or KEY_...
  int give_back = -1;
};

/// The usual map of a device. The first row that applies to the device gives its pedals:
///
///     Device                     Throttle                  Brake
///     has ABS_GAS and ABS_BRAKE  ABS_GAS                   ABS_BRAKE
///     gamepad with triggers      right trigger (ABS_RZ)    left trigger (ABS_Z)
///     has ABS_Z and ABS_RZ       ABS_Z                     ABS_RZ
///     keyboard                   arrow up                  arrow down
///
/// The third row is for wheels. Their axes have the greatest value when the pedal is released, as
/// on Logitech's wheels.
///
/// The buttons to take over and to give back are, in this order: south (A) and east (B) of a
/// gamepad, the first and the second button of a wheel, or the keys space and g of a keyboard.
/// @return nullopt if the device has neither pedals nor arrow keys
std::optional<DeviceMap> UsualMap(const DeviceFeatures& features);

/// A pedal as the user names it: "ABS_RZ", or "-ABS_RZ" if the axis has its greatest value when the
/// pedal is released.
/// @throws InputError that names `option` if the kernel has no axis of this name
PedalAxis ParsePedal(std::string_view text, std::string_view option);
/// A button as the user names it: "BTN_SOUTH" or "KEY_SPACE".
/// @throws InputError that names `option` if the kernel has no button of this name
int ParseButton(std::string_view text, std::string_view option);

/// The usual map of a device, with the axes and buttons that the user has named.
/// @return nullopt if the device has neither pedals nor arrow keys, or if only one of the pedals
/// has
///     an axis, or if both have the same axis
/// @throws InputError as ParsePedal() and ParseButton()
std::optional<DeviceMap> MapOf(const DeviceFeatures& features, const DeviceNames& names);

}  // namespace fogline::drive
