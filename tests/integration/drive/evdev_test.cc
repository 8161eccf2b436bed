// `fogline drive --evdev` with an input device that the test creates in the kernel (uinput).
#include <fcntl.h>
#include <libevdev/libevdev-uinput.h>
#include <libevdev/libevdev.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "services/log/driver_inputs.h"
#include "services/log/run_log.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/drive/driven_run.h"

namespace fogline::test {
namespace {

/// A gamepad: two triggers from 0 to 255, and its buttons A and B.
class Gamepad {
 public:
  Gamepad() {
    libevdev* device = libevdev_new();
    libevdev_set_name(device, "Fogline's test gamepad");
    libevdev_enable_event_type(device, EV_ABS);
    const input_absinfo range{
        .value = 0, .minimum = 0, .maximum = 255, .fuzz = 0, .flat = 0, .resolution = 0};
    for (const unsigned code : {ABS_Z, ABS_RZ}) {
      libevdev_enable_event_code(device, EV_ABS, code, &range);
    }
    libevdev_enable_event_type(device, EV_KEY);
    for (const unsigned code : {BTN_SOUTH, BTN_EAST}) {
      libevdev_enable_event_code(device, EV_KEY, code, nullptr);
    }
    if (libevdev_uinput_create_from_device(device, LIBEVDEV_UINPUT_OPEN_MANAGED, &uinput_) != 0) {
      uinput_ = nullptr;
    }
    libevdev_free(device);
  }
  ~Gamepad() { Unplug(); }
  Gamepad(const Gamepad&) = delete;
  Gamepad& operator=(const Gamepad&) = delete;

  /// Whether this machine has made the device and shows it as a file that the test may read.
  bool exists() const {
    return uinput_ != nullptr && libevdev_uinput_get_devnode(uinput_) != nullptr &&
           access(file().c_str(), R_OK) == 0;
  }
  std::string file() const { return libevdev_uinput_get_devnode(uinput_); }
  void Set(unsigned type, unsigned code, int value) {
    libevdev_uinput_write_event(uinput_, type, code, value);
    libevdev_uinput_write_event(uinput_, EV_SYN, SYN_REPORT, 0);
  }
  void Unplug() {
    if (uinput_ != nullptr) libevdev_uinput_destroy(uinput_);
    uinput_ = nullptr;
  }

 private:
  libevdev_uinput* uinput_ = nullptr;
};

TEST(EvdevInRealtimeTest, AGamepadDrivesAndItsUnpluggingStopsTheHost) {
  Gamepad gamepad;
  // If the machine has no uinput, the test is skipped even with FOGLINE_TEST_NO_SKIP, because no
  // package adds uinput to a container. The unit tests of tools/drive check what a device's values
  // mean.
  if (!gamepad.exists()) GTEST_SKIP() << "this machine has no /dev/uinput: " << strerror(errno);
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  const std::string url = runtime::FreshMulticastUrl();
  std::vector<std::string> command{
      Program("fogline"), "drive", kDriveScenario, "--evdev",   gamepad.file(), "--log", log,
      "--lcm-url",        url,     "--set",        "/steps=400"};
  for (const std::string& setting : AlwaysAsked()) {
    command.insert(command.end(), {"--set", setting});
  }
  Background program(command);
  Commands commands(url);
  ASSERT_GE(commands.WaitFor([&] { return commands.driver.input_instance != 0; }), 0)
      << program.Err();
  gamepad.Set(EV_KEY, BTN_SOUTH, 1);
  ASSERT_GE(commands.WaitFor([&] { return commands.host.mode == arbitration_t::RECOVERING; }), 0);
  gamepad.Set(EV_ABS, ABS_RZ, 255);
  EXPECT_GE(commands.WaitFor([&] { return commands.driver.acceleration_mps2 == 3; }), 0);
  gamepad.Set(EV_ABS, ABS_RZ, 0);
  gamepad.Set(EV_ABS, ABS_Z, 255);
  EXPECT_GE(commands.WaitFor([&] { return commands.driver.acceleration_mps2 == -8; }), 0);
  gamepad.Unplug();
  EXPECT_GE(commands.WaitFor([&] { return commands.driver.readiness == 0; }), 0);
  EXPECT_GE(commands.WaitFor([&] { return commands.host.mode == arbitration_t::MINIMAL_RISK; }), 0);
  EXPECT_EQ(program.Wait(), 0) << program.Err();
}

}  // namespace
}  // namespace fogline::test
