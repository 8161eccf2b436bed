// `fogline drive --keys` in a pseudo-terminal. The test types at the other end of the
// pseudo-terminal.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/clock.h"
#include "common/process/priority.h"
#include "services/log/driver_inputs.h"
#include "services/log/event_log.h"
#include "services/log/run_log.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/drive/driven_run.h"
#include "tests/integration/drive/in_terminal.h"
#include "tests/support/machine.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using Words = std::vector<std::string>;

class KeysInRealtimeTest : public testing::Test {
 protected:
  Words Drive(int steps, const Words& settings = AlwaysAsked()) const {
    Words command{Program("fogline"),
                  "drive",
                  kDriveScenario,
                  "--keys",
                  "--log",
                  log_,
                  "--lcm-url",
                  url_,
                  "--set",
                  "/steps=" + std::to_string(steps)};
    for (const std::string& setting : settings) {
      command.insert(command.end(), {"--set", setting});
    }
    return command;
  }
  std::vector<driver_input_t> Inputs() const {
    log::RunLogReader reader(log_);
    while (reader.Next() != nullptr) {
    }
    return log::ReadDriverInputs(log_, reader.run().run_id);
  }
  std::string Answered() const { return RunCommand({Program("fogline"), "events", log_}).out; }

  ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  const std::string url_ = runtime::FreshMulticastUrl();
};

TEST_F(KeysInRealtimeTest, DriveTheHostAndTheTerminalIsRestoredAtTheEnd) {
  Words settings = AlwaysAsked();
  settings.emplace_back(kALatePersonIsThere);
  InTerminal program(Drive(1000, settings));
  Commands commands(url_);
  ASSERT_TRUE(program.WaitUntil([&] { return program.IsRaw(); })) << program.text();
  ASSERT_GE(commands.WaitFor([&] { return commands.driver.input_instance != 0; }), 0);
  // WHEN the person takes over with the space bar
  program.Type(" ");
  ASSERT_GE(commands.WaitFor([&] { return commands.host.mode == arbitration_t::RECOVERING; }), 0);
  // THEN the arrow up accelerates the host more than released pedals, and the arrow down brakes it.
  // On a busy machine the thread of the seat may miss a single tap of 0.12 s, so the test repeats
  // the tap
  const auto tap_until = [&](const char* key, const std::function<bool()>& holds) {
    constexpr int kTaps = 5;
    double waited_s = -1;
    for (int i = 0; i < kTaps && waited_s < 0; ++i) {
      program.Type(key);
      waited_s = commands.WaitFor(holds, milliseconds(1000));
    }
    return waited_s >= 0;
  };
  EXPECT_TRUE(tap_until("\x1b[A", [&] { return commands.host.acceleration_mps2 > -0.3; }));
  EXPECT_TRUE(tap_until("\x1b[B", [&] { return commands.host.acceleration_mps2 < -0.8; }));
  EXPECT_EQ(program.Wait(), 0) << program.text();
  EXPECT_TRUE(program.IsAsBefore());
  const auto inputs = Inputs();
  ASSERT_FALSE(inputs.empty());
  EXPECT_EQ(inputs.front().device, "terminal");
  EXPECT_EQ(inputs.front().device_kind, driver_input_t::KEYBOARD);
  EXPECT_THAT(Answered(), HasSubstr("acknowledgement by the person"));
  EXPECT_EQ(RunCommand({Program("fogline"), "replay", log_, "--role", "driver"}).code, 0);
}

TEST_F(KeysInRealtimeTest, APersonWhoIsNotAskedIsToldWhoDrives) {
  InTerminal program(Drive(150, {"/person/drives=true", "/arbitrator/threshold=0",
                                 "/arbitrator/take_over/mode=instant"}));
  EXPECT_TRUE(program.WaitUntil([&] {
    return program.text().find(">>> you drive") != std::string::npos;
  })) << program.text();
  EXPECT_EQ(program.Wait(), 0) << program.text();
}

TEST_F(KeysInRealtimeTest, TheThreadOfTheSeatRunsBeforeOtherThreads) {
  bool granted = false;
  std::thread([&granted] { granted = RunThreadBeforeOthers(1); }).join();
  if (!granted) return MachineLacks("the right to real-time priority");
  InTerminal program(Drive(4000));
  EXPECT_TRUE(program.WaitUntil([&] { return ThreadsBeforeOthers(program.pid()) == 1; }));
  program.Type("\x03");
  EXPECT_EQ(program.Wait(), 130) << program.text();
}

TEST_F(KeysInRealtimeTest, TheTerminalIsRestoredAfterCtrlC) {
  InTerminal program(Drive(4000));
  Commands commands(url_);
  ASSERT_TRUE(program.WaitUntil([&] { return program.IsRaw(); })) << program.text();
  ASSERT_GE(commands.WaitFor([&] { return commands.host.header.step > 10; }), 0);
  program.Type("\x03");
  EXPECT_EQ(program.Wait(), 130) << program.text();
  EXPECT_TRUE(program.IsAsBefore());
}

TEST_F(KeysInRealtimeTest, TheTerminalIsRestoredAfterSigterm) {
  InTerminal program(Drive(4000));
  ASSERT_TRUE(program.WaitUntil([&] { return program.IsRaw(); })) << program.text();
  kill(program.pid(), SIGTERM);
  EXPECT_EQ(program.Wait(), 130) << program.text();
  EXPECT_TRUE(program.IsAsBefore());
}

// The verb opens the terminal, and then finds that it cannot write the log.
TEST_F(KeysInRealtimeTest, TheTerminalIsRestoredAfterAnError) {
  Words command = Drive(100);
  *(std::ranges::find(command, "--log") + 1) = "/nowhere/run.lcm";
  InTerminal program(command);
  EXPECT_EQ(program.Wait(), 2) << program.text();
  EXPECT_TRUE(program.IsAsBefore());
}

TEST_F(KeysInRealtimeTest, AreRefusedWithoutATerminal) {
  Words command = Drive(100);
  EXPECT_THAT(RunCommand(command).err, HasSubstr("error: --keys: standard input is no terminal"));
  // The person still drives if --set replaces the whole section /person by a section without
  // "drives". So --keys still needs a terminal.
  command.insert(command.end(), {"--set", R"(/person={"override_by":"none"})"});
  const Outcome outcome = RunCommand(command);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("error: --keys: standard input is no terminal"));
}

TEST_F(KeysInRealtimeTest, AnInputDeviceMustBeOne) {
  Words command = Drive(100);
  std::erase(command, "--keys");
  command.push_back("--evdev");
  command.push_back("/dev/null");
  const Outcome no_device = RunCommand(command);
  EXPECT_EQ(no_device.code, 2);
  EXPECT_THAT(no_device.err, HasSubstr("error: --evdev /dev/null: no input device"));
}

}  // namespace
}  // namespace fogline::test
