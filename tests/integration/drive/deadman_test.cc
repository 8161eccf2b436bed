// Tests of the fallback when a person who drives leaves suddenly. The processes are real and follow
// the wall clock.
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "services/log/event_log.h"
#include "tests/integration/drive/driven_run.h"

namespace fogline::test {
namespace {

constexpr int kSteps = 1000;  // 20 s; each test ends its run earlier
constexpr double kDeadman_s = 0.3;
// A test starts its clock when it stops or kills the seat. The seat sends every 40 ms, and the
// driver answers every 20 ms. So the last input may already be up to 0.06 s old when the clock
// starts. Then the fallback may begin when the clock shows only kDeadman_s - 0.06 s.
constexpr double kInTime_s = kDeadman_s - 0.06;
// Two periods of the driver. The time of an input is that of the newest step, so it may be one
// period too early. The driver checks only once in each step whether a further input has come.
constexpr double kTwoPeriods_s = 0.04;
// The longest time for which a busy machine may delay a process. The campaign test
// tests/campaign/web/drive_run.test.js allows only 0.25 s.
constexpr double kAllowance_s = 3;

class DeadmanInRealtimeTest : public testing::Test {
 protected:
  /// Waits until the person has taken over and presses the throttle.
  void WaitUntilThePersonDrives() {
    ASSERT_GE(commands_.WaitFor([&] {
      return commands_.host.mode == arbitration_t::RECOVERING &&
             commands_.driver.acceleration_mps2 > 0.1;
    }),
              0)
        << run_.run().Err();
    EXPECT_EQ(commands_.driver.readiness, 1);
    EXPECT_NE(commands_.driver.input_instance, 0);
    EXPECT_GE(commands_.driver.input_sequence, 0);
  }

  /// Expects that no person drives any more, and that the host stops by itself. @return the time in
  /// s from `since` until the driver was not ready
  double ExpectTheFallback(TimePoint since = Clock::now()) {
    EXPECT_GE(commands_.WaitFor([&] { return commands_.driver.readiness == 0; }), 0)
        << "the driver is still ready";
    const double after_s = Seconds(Clock::now() - since);
    EXPECT_EQ(commands_.driver.acceleration_mps2, -0.5) << "the pedals are released";
    EXPECT_EQ(commands_.driver.input_instance, 0);
    EXPECT_EQ(commands_.driver.input_sequence, -1);
    EXPECT_FALSE(commands_.driver.acknowledged);
    EXPECT_GE(commands_.WaitFor([&] { return commands_.host.mode == arbitration_t::MINIMAL_RISK; },
                                std::chrono::seconds(3)),
              0)
        << "mode " << static_cast<int>(commands_.host.mode);
    EXPECT_EQ(commands_.host.lambda_human, 0);
    return after_s;
  }

  /// Ends the run 1 s later, and checks its log. The driver's readiness must become 0 soon enough
  /// after the last input of the person. From then on the pedals must be released.
  void ExpectTheLogToShowIt(double deadman_s) {
    run_.WaitForStep(commands_.driver.header.step + 50);
    run_.run().Signal(SIGINT);
    run_.run().Wait();
    const std::int64_t input_us = LastInput_us();
    ASSERT_GE(input_us, 0);
    std::vector<driver_command_t> commands;
    log::EventLogReader reader(run_.log());
    while (const auto event = reader.Next()) {
      driver_command_t command{};
      if (event->channel == ChannelOf<driver_command_t>().name &&
          runtime::Decode(event->data, command)) {
        commands.push_back(command);
      }
    }
    const auto ready = std::find_if(commands.rbegin(), commands.rend(),
                                    [](const auto& command) { return command.readiness > 0; });
    ASSERT_NE(ready, commands.rend());
    const auto away = ready.base();  // the first command after all commands of a ready driver
    ASSERT_NE(away, commands.end());
    for (auto command = away; command != commands.end(); ++command) {
      EXPECT_EQ(command->acceleration_mps2, -0.5) << "step " << command->header.step;
    }
    const double after_s = static_cast<double>(away->header.utime - input_us) / kMicrosPerSecond;
    EXPECT_LE(after_s, deadman_s + kTwoPeriods_s + kAllowance_s);
  }

  /// Finds in the log the last DRIVER_INPUT that says that a person is present. @return its utime;
  /// -1 if there is none
  std::int64_t LastInput_us() {
    std::int64_t input_us = -1;
    log::EventLogReader reader(run_.log());
    while (const auto event = reader.Next()) {
      driver_input_t input{};
      if (event->channel == ChannelOf<driver_input_t>().name &&
          runtime::Decode(event->data, input) && input.present) {
        input_us = input.header.utime;
      }
    }
    return input_us;
  }

  RealtimeRun run_{kDriveScenario, kSteps, 1, AlwaysAsked()};
  Commands commands_{run_.url()};
};

TEST_F(DeadmanInRealtimeTest, ASilentSeatIsNoticedAfterTheDeadmansTime) {
  Background seat(SeatCommand(run_.url(), "0 0.4 0 1 1"));
  WaitUntilThePersonDrives();
  const TimePoint silent = Clock::now();
  seat.Signal(SIGSTOP);
  EXPECT_GE(ExpectTheFallback(silent), kInTime_s);
  ExpectTheLogToShowIt(kDeadman_s);
  seat.Signal(SIGCONT);
}

TEST_F(DeadmanInRealtimeTest, AKilledSeatIsNoticedAfterTheDeadmansTime) {
  Background seat(SeatCommand(run_.url(), "0 0.4 0 1 1"));
  WaitUntilThePersonDrives();
  const TimePoint silent = Clock::now();
  seat.Signal(SIGKILL);
  EXPECT_GE(ExpectTheFallback(silent), kInTime_s);
  ExpectTheLogToShowIt(kDeadman_s);
}

// If the device is unplugged, the seat still sends messages, which say that no person is present.
TEST_F(DeadmanInRealtimeTest, AnUnpluggedDeviceCountsAtOnce) {
  Background seat(SeatCommand(run_.url(), "0 0.4 0 1 1; 4 0.4 0 1 0"));
  WaitUntilThePersonDrives();
  ExpectTheFallback();
  EXPECT_TRUE(IsAlive(seat.pid()));
  ExpectTheLogToShowIt(0);
}

TEST_F(DeadmanInRealtimeTest, ASeatThatEndsSaysSo) {
  Background seat(SeatCommand(run_.url(), "0 0.4 0 1 1"));
  WaitUntilThePersonDrives();
  seat.Signal(SIGTERM);
  ExpectTheFallback();
  ExpectTheLogToShowIt(0);
}

}  // namespace
}  // namespace fogline::test
