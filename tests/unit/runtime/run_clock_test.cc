#include "services/runtime/run_clock.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr Duration kPeriod = milliseconds(100);
constexpr TimePoint kBegan{std::chrono::hours(5)};

TimePoint At(std::int64_t ms) { return kBegan + milliseconds(ms); }

class RunClockTest : public testing::Test {
 protected:
  // The world's steps 0, 1, ... from 1000 ms on, in its rhythm.
  void Tick(std::int64_t steps) {
    for (std::int64_t k = 0; k < steps; ++k) clock_.Tick(k, At(1000 + 100 * k));
  }
  RunClock clock_{kPeriod, kBegan};
};

TEST_F(RunClockTest, StandsAtItsBeginningUntilTheFirstTick) {
  EXPECT_FALSE(clock_.started());
  EXPECT_EQ(clock_.At(At(700)), kBegan);
  clock_.Tick(0, At(1000));
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
  Tick(5);  // the last one at 1400
  EXPECT_EQ(clock_.At(At(1525)), At(525));
  EXPECT_EQ(clock_.At(At(1526)), At(525));
  EXPECT_EQ(clock_.At(At(9000)), At(525));
  EXPECT_EQ(clock_.Wall(At(525)), At(1525));
  EXPECT_EQ(clock_.Wall(At(526)), TimePoint::max());
}

TEST_F(RunClockTest, GoesOnWhereItStoodWhenTheWorldDoes) {
  Tick(5);
  clock_.Tick(5, At(9000));
  EXPECT_EQ(clock_.At(At(9000)), At(525));
  EXPECT_EQ(clock_.At(At(9050)), At(575));
}

TEST_F(RunClockTest, TakesTicksThatWereNotHeardForNoPause) {
  Tick(5);
  clock_.Tick(8, At(1800));
  EXPECT_EQ(clock_.At(At(1800)), At(800));
}

TEST_F(RunClockTest, NeverGoesBackwards) {
  Tick(5);
  TimePoint last = clock_.At(At(1400));
  std::int64_t step = 5;
  for (std::int64_t ms = 1400; ms < 4000; ms += 7) {
    // A tick now and then, from too early to far too late, and some that are known.
    if (ms % 3 == 0 && ms % 5 != 0) clock_.Tick(ms % 2 == 0 ? step++ : step - 1, At(ms));
    EXPECT_GE(clock_.At(At(ms)), last) << ms;
    last = clock_.At(At(ms));
  }
}

TEST_F(RunClockTest, IgnoresATickThatIsKnown) {
  Tick(5);
  clock_.Tick(4, At(1450));
  clock_.Tick(2, At(1460));
  EXPECT_EQ(clock_.At(At(9000)), At(525));
}

}  // namespace
}  // namespace fogline
