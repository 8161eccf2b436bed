#include "services/runtime/realtime/run_clock.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/services/runtime/realtime/run_times.h"

namespace fogline {
namespace {

class RunClockTest : public testing::Test {
 protected:
  // Passes the world's steps 0, 1, ... to the clock. Each step is in time; step 0 comes at 1000 ms.
  void Tick(std::int64_t steps) {
    for (std::int64_t k = 0; k < steps; ++k) clock_.Heard(k, At(1000 + 100 * k));
  }
  runtime::RunClock clock_{kPeriod, kBegan};
};

TEST_F(RunClockTest, StandsAtItsBeginningUntilTheFirstTick) {
  EXPECT_FALSE(clock_.started());
  EXPECT_EQ(clock_.At(At(700)), kBegan);
  clock_.Heard(0, At(1000));
  EXPECT_TRUE(clock_.started());
  EXPECT_EQ(clock_.At(At(1000)), kBegan);
}

TEST_F(RunClockTest, GoesWithTheWallWhileTheWorldTicks) {
  Tick(5);
  EXPECT_EQ(clock_.At(At(1400)), At(400));
  EXPECT_EQ(clock_.At(At(1450)), At(450));
  EXPECT_EQ(clock_.Wall(At(450)), At(1450));
}

TEST_F(RunClockTest, StandsStillFromAQuarterPeriodAfterATickIsOverdue) {
  Tick(5);  // the last tick comes at 1400
  EXPECT_EQ(clock_.At(At(1525)), At(525));
  EXPECT_EQ(clock_.At(At(1526)), At(525));
  EXPECT_EQ(clock_.At(At(9000)), At(525));
  EXPECT_EQ(clock_.Wall(At(525)), At(1525));
  EXPECT_EQ(clock_.Wall(At(526)), TimePoint::max());
}

TEST_F(RunClockTest, GoesOnWhereItStoodWhenTheWorldDoes) {
  Tick(5);
  clock_.Heard(5, At(9000));
  EXPECT_EQ(clock_.At(At(9000)), At(525));
  EXPECT_EQ(clock_.At(At(9050)), At(575));
}

TEST_F(RunClockTest, TakesStepsThatWereNotHeardForNoPause) {
  Tick(5);
  clock_.Heard(8, At(1800));
  EXPECT_EQ(clock_.At(At(1800)), At(800));
}

TEST_F(RunClockTest, TakesAMessageThatComesLateForNoPause) {
  Tick(5);
  // GIVEN a second without messages, after which repeated messages come first
  clock_.Heard(9, At(2391));
  clock_.Heard(11, At(2392));
  // THEN the current step sets the clock as if the repeated messages had not come
  clock_.Heard(14, At(2400));
  EXPECT_EQ(clock_.At(At(2400)), At(1400));
  EXPECT_EQ(clock_.At(At(2450)), At(1450));
}

TEST_F(RunClockTest, GoesNoFasterThanTheWallWhenTicksComeEarlyAndLate) {
  for (std::int64_t k = 0; k < 1000; ++k) clock_.Heard(k, At(1000 + 100 * k + (k % 3) * 10));
  EXPECT_LE(clock_.At(At(101'000)), At(100'000));
  EXPECT_GE(clock_.At(At(101'000)), At(99'900));
}

TEST_F(RunClockTest, IsNotAheadOfTheWallWhateverStepAMessageClaims) {
  Tick(5);
  clock_.Heard(std::numeric_limits<std::int64_t>::max(), At(1500));
  EXPECT_LE(clock_.At(At(1600)), At(1600));
}

TEST_F(RunClockTest, NeverGoesBackwards) {
  Tick(5);
  TimePoint last = clock_.At(At(1400));
  std::int64_t step = 5;
  for (std::int64_t ms = 1400; ms < 4000; ms += 7) {
    // The ticks come at irregular times, from too early to far too late. Some ticks are repeated.
    if (ms % 3 == 0 && ms % 5 != 0) clock_.Heard(ms % 2 == 0 ? step++ : step - 1, At(ms));
    EXPECT_GE(clock_.At(At(ms)), last) << ms;
    last = clock_.At(At(ms));
  }
}

TEST_F(RunClockTest, IgnoresATickThatIsKnown) {
  Tick(5);
  clock_.Heard(4, At(1450));
  clock_.Heard(2, At(1460));
  EXPECT_EQ(clock_.At(At(9000)), At(525));
}

}  // namespace
}  // namespace fogline
