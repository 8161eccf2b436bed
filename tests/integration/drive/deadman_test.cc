// Tests of the fallback when a person who drives leaves suddenly. The processes are real and follow
// the wall clock.
#include <csignal>
#include <string>

#include <gtest/gtest.h>

#include "tests/integration/drive/driven_run.h"

namespace fogline::test {
namespace {

constexpr int kSteps = 1000;  // 20 s; each test ends its run earlier
constexpr double kDeadman_s = 0.3;
// The tests measure the time from the end of the seat's messages. The seat sends every 40 ms, and
// the driver answers every 20 ms. So the last input may be up to 0.06 s old when this time begins,
// and the fallback may come up to 0.06 s before kDeadman_s has passed.
constexpr double kInTime_s = kDeadman_s - 0.06;
// The longest time for which a busy machine may delay a process.
constexpr double kSlack_s = 3;

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
  /// s until the driver was not ready
  double ExpectTheFallback() {
    const double after_s = commands_.WaitFor([&] { return commands_.driver.readiness == 0; });
    EXPECT_GE(after_s, 0) << "the driver is still ready";
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

  RealtimeRun run_{kDriveScenario, kSteps, 1, AlwaysAsked()};
  Commands commands_{run_.url()};
};

TEST_F(DeadmanInRealtimeTest, ASilentSeatIsNoticedAfterTheDeadmansTime) {
  Background seat(SeatCommand(run_.url(), "0 0.4 0 1 1"));
  WaitUntilThePersonDrives();
  seat.Signal(SIGSTOP);
  const double after_s = ExpectTheFallback();
  EXPECT_GE(after_s, kInTime_s);
  EXPECT_LT(after_s, kDeadman_s + kSlack_s);
  seat.Signal(SIGCONT);
}

TEST_F(DeadmanInRealtimeTest, AKilledSeatIsNoticedAfterTheDeadmansTime) {
  Background seat(SeatCommand(run_.url(), "0 0.4 0 1 1"));
  WaitUntilThePersonDrives();
  seat.Signal(SIGKILL);
  const double after_s = ExpectTheFallback();
  EXPECT_GE(after_s, kInTime_s);
  EXPECT_LT(after_s, kDeadman_s + kSlack_s);
}

// If the device is unplugged, the seat still sends messages, which say that no person is present.
TEST_F(DeadmanInRealtimeTest, AnUnpluggedDeviceCountsAtOnce) {
  Background seat(SeatCommand(run_.url(), "0 0.4 0 1 1; 4 0.4 0 1 0"));
  WaitUntilThePersonDrives();
  ExpectTheFallback();
  EXPECT_TRUE(IsAlive(seat.pid()));
}

TEST_F(DeadmanInRealtimeTest, ASeatThatEndsSaysSo) {
  Background seat(SeatCommand(run_.url(), "0 0.4 0 1 1"));
  WaitUntilThePersonDrives();
  seat.Signal(SIGTERM);
  ExpectTheFallback();
}

}  // namespace
}  // namespace fogline::test
