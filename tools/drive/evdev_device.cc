#include "tools/drive/evdev_device.h"

#include <fcntl.h>
#include <libevdev/libevdev.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/process/console.h"
#include "common/text.h"
#include "services/runtime/wire/driver_input.h"

namespace fogline::drive {
namespace {

DeviceFeatures FeaturesOf(const libevdev* device) {
  const auto has = [device](unsigned type, unsigned code) {
    return libevdev_has_event_code(device, type, code) != 0;
  };
  return {.gas_and_brake = has(EV_ABS, ABS_GAS) && has(EV_ABS, ABS_BRAKE),
          .triggers = has(EV_ABS, ABS_Z) && has(EV_ABS, ABS_RZ),
          .is_gamepad = has(EV_KEY, BTN_GAMEPAD),
          .arrow_keys = has(EV_KEY, KEY_UP) && has(EV_KEY, KEY_DOWN)};
}

}  // namespace

EvdevDevice::EvdevDevice(std::filesystem::path path, const DeviceNames& names,
                         const PersonSection& person)
    : path_(std::move(path)), names_(names), keys_(person) {
  if (const std::string why = Open(); !why.empty()) {
    throw InputError(fmt::format("error: --evdev {}: {}", PathText(path_), why));
  }
}

EvdevDevice::~EvdevDevice() { Close(); }

std::string EvdevDevice::Open() {
  fd_ = open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd_ < 0) return std::strerror(errno);
  if (const int error = libevdev_new_from_fd(fd_, &device_); error < 0) {
    device_ = nullptr;
    Close();
    return fmt::format("no input device: {}", std::strerror(-error));
  }
  const std::optional<DeviceMap> map = MapOf(FeaturesOf(device_), names_);
  if (!map) {
    Close();
    return "Fogline does not know its two pedals; name their axes with --throttle and --brake";
  }
  map_ = *map;
  for (const auto& pedal : {map_.throttle, map_.brake}) {
    if (!pedal || libevdev_has_event_code(device_, EV_ABS, static_cast<unsigned>(pedal->code)))
      continue;
    const char* name = libevdev_event_code_get_name(EV_ABS, static_cast<unsigned>(pedal->code));
    Close();
    return fmt::format("has no axis {}", name);
  }
  name_ = libevdev_get_name(device_);
  throttle_moved_ = brake_moved_ = false;
  keys_.Drop();  // an unplugged device does not report that its keys go up
  return "";
}

void EvdevDevice::Close() {
  if (device_ != nullptr) libevdev_free(std::exchange(device_, nullptr));
  if (fd_ >= 0) close(std::exchange(fd_, -1));
}

PedalState EvdevDevice::Read(TimePoint now) {
  if (device_ == nullptr && now >= open_at_) {
    open_at_ = now + kOpenAgain;
    if (Open().empty()) Notice(fmt::format("{} is there again", PathText(path_)));
  }
  if (device_ != nullptr) ReadEvents(now);
  if (device_ == nullptr) return {.present = false, .axes = {}, .at = at_};
  PedalState state{.axes = {}, .at = at_};
  if (map_.throttle && map_.brake) {
    state.throttle = TravelOf(*map_.throttle, throttle_moved_);
    state.brake = TravelOf(*map_.brake, brake_moved_);
  } else {
    keys_.MoveTo(now);
    state.throttle = keys_.throttle();
    state.brake = keys_.brake();
  }
  const auto down = [this](int code) {
    return code >= 0 && libevdev_get_event_value(device_, EV_KEY, static_cast<unsigned>(code)) != 0;
  };
  if (down(map_.take_over)) state.buttons |= driver_input_t::TAKE_OVER;
  if (down(map_.give_back)) state.buttons |= driver_input_t::GIVE_BACK;
  for (unsigned code = 0; code < ABS_CNT && std::ssize(state.axes) < runtime::kMostAxes; ++code) {
    if (libevdev_has_event_code(device_, EV_ABS, code) == 0) continue;
    state.axes.push_back(
        Scaled(libevdev_get_event_value(device_, EV_ABS, code), RangeOf(static_cast<int>(code))));
  }
  return state;
}

void EvdevDevice::ReadEvents(TimePoint now) {
  unsigned flag = LIBEVDEV_READ_FLAG_NORMAL;
  while (true) {
    input_event event{};
    const int result = libevdev_next_event(device_, flag, &event);
    if (result == -EAGAIN && flag == LIBEVDEV_READ_FLAG_SYNC) {
      flag = LIBEVDEV_READ_FLAG_NORMAL;  // all dropped events have been read
      continue;
    }
    if (result == -EAGAIN || result == -EINTR) return;
    if (result < 0) {
      Notice(fmt::format("{} is gone: {}", PathText(path_), std::strerror(-result)));
      Close();
      open_at_ = now + kOpenAgain;
      return;
    }
    if (result == LIBEVDEV_READ_STATUS_SYNC) flag = LIBEVDEV_READ_FLAG_SYNC;
    Take(event, now);
  }
}

void EvdevDevice::Take(const input_event& event, TimePoint now) {
  if (event.type == EV_SYN) return;
  at_ = now;
  if (event.type == EV_ABS) {
    throttle_moved_ = throttle_moved_ || (map_.throttle && event.code == map_.throttle->code);
    brake_moved_ = brake_moved_ || (map_.brake && event.code == map_.brake->code);
  }
  if (event.type != EV_KEY || map_.throttle || event.value == 2) return;  // 2: key repeat
  if (event.code == KEY_UP) keys_.Hold(PedalKey::kThrottle, event.value != 0, now);
  if (event.code == KEY_DOWN) keys_.Hold(PedalKey::kBrake, event.value != 0, now);
}

AxisRange EvdevDevice::RangeOf(int code) const {
  const auto axis = static_cast<unsigned>(code);
  return {.least = libevdev_get_abs_minimum(device_, axis),
          .most = libevdev_get_abs_maximum(device_, axis)};
}

double EvdevDevice::TravelOf(const PedalAxis& pedal, bool moved) const {
  if (!moved) return 0;
  const auto axis = static_cast<unsigned>(pedal.code);
  return pedal.Travel(libevdev_get_event_value(device_, EV_ABS, axis), RangeOf(pedal.code));
}

}  // namespace fogline::drive
