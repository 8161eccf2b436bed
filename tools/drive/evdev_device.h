// An input device of the kernel (evdev): a gamepad, a wheel with pedals, or a keyboard.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "tools/drive/evdev_map.h"
#include "tools/drive/key_pedals.h"
#include "tools/drive/pedal_source.h"

struct libevdev;
struct input_event;

namespace fogline::drive {

/// Reads the pedals and buttons of an input device. A pedal counts as released until its axis has
/// moved, because wheels report wrong values before the first movement. While the device is
/// unplugged, no person is present. When the device is plugged in again, this class opens it again.
class EvdevDevice final : public PedalSource {
 public:
  /// @throws InputError if the device cannot be read, if MapOf() finds no map for it, or if the
  ///     device lacks an axis of this map; also as ParsePedal() and ParseButton()
  EvdevDevice(std::filesystem::path path, const DeviceNames& names, const PersonSection& person);
  ~EvdevDevice() override;

  PedalState Read(TimePoint now) override;
  int fd() const override { return fd_; }
  std::int8_t kind() const override { return driver_input_t::EVDEV; }
  std::string name() const override { return name_; }

 private:
  static constexpr Duration kOpenAgain = milliseconds(500);

  /// @return why the device cannot be read; "" if it was opened
  std::string Open();
  void Close();
  void ReadEvents(TimePoint now);
  void Take(const input_event& event, TimePoint now);
  AxisRange RangeOf(int code) const;
  double TravelOf(const PedalAxis& pedal, bool moved) const;

  std::filesystem::path path_;
  DeviceNames names_;
  libevdev* device_ = nullptr;  // nullptr while the device is unplugged
  int fd_ = -1;
  std::string name_;
  DeviceMap map_;
  KeyPedals keys_;
  bool throttle_moved_ = false;
  bool brake_moved_ = false;
  TimePoint at_{};
  TimePoint open_at_{};  // the time of the next attempt to open the device
};

}  // namespace fogline::drive
