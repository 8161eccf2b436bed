#include "tools/drive/evdev_map.h"

#include <libevdev/libevdev.h>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"

namespace fogline::drive {

std::optional<DeviceMap> UsualMap(const DeviceFeatures& features) {
  DeviceMap map;
  if (features.gas_and_brake) {
    map.throttle = PedalAxis{.code = ABS_GAS};
    map.brake = PedalAxis{.code = ABS_BRAKE};
  } else if (features.triggers && features.is_gamepad) {
    map.throttle = PedalAxis{.code = ABS_RZ};
    map.brake = PedalAxis{.code = ABS_Z};
  } else if (features.triggers) {
    map.throttle = PedalAxis{.code = ABS_Z, .inverted = true};
    map.brake = PedalAxis{.code = ABS_RZ, .inverted = true};
  } else if (!features.arrow_keys) {
    return std::nullopt;
  }
  if (!map.throttle) {
    map.take_over = KEY_SPACE;
    map.give_back = KEY_G;
  } else {
    map.take_over = features.is_gamepad ? BTN_SOUTH : BTN_TRIGGER;
    map.give_back = features.is_gamepad ? BTN_EAST : BTN_THUMB;
  }
  return map;
}

PedalAxis ParsePedal(std::string_view text, std::string_view option) {
  const bool inverted = text.starts_with('-');
  const std::string name(inverted ? text.substr(1) : text);
  const int code = libevdev_event_code_from_name(EV_ABS, name.c_str());
  if (code < 0) {
    throw InputError(
        fmt::format("error: {} {}: no axis; axes are named ABS_RZ, or -ABS_RZ if the axis has its "
                    "greatest value when the pedal is released; evtest DEVICE lists them",
                    option, Shown(text)));
  }
  return {.code = code, .inverted = inverted};
}

int ParseButton(std::string_view text, std::string_view option) {
  const int code = libevdev_event_code_from_name(EV_KEY, std::string(text).c_str());
  if (code < 0) {
    throw InputError(fmt::format(
        "error: {} {}: no button; buttons are named BTN_SOUTH or KEY_SPACE; evtest DEVICE lists "
        "them",
        option, Shown(text)));
  }
  return code;
}

std::optional<DeviceMap> MapOf(const DeviceFeatures& features, const DeviceNames& names) {
  const std::optional<DeviceMap> usual = UsualMap(features);
  DeviceMap map = usual.value_or(DeviceMap());
  if (!names.throttle.empty()) map.throttle = ParsePedal(names.throttle, "--throttle");
  if (!names.brake.empty()) map.brake = ParsePedal(names.brake, "--brake");
  if (!names.take_over.empty()) map.take_over = ParseButton(names.take_over, "--take-over");
  if (!names.give_back.empty()) map.give_back = ParseButton(names.give_back, "--give-back");
  if (!map.throttle && !map.brake && usual) return map;  // the arrow keys are the pedals
  if (!map.throttle || !map.brake || map.throttle->code == map.brake->code) return std::nullopt;
  return map;
}

}  // namespace fogline::drive
