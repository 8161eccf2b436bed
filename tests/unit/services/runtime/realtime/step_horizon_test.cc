#include "services/runtime/realtime/step_horizon.h"

#include <gtest/gtest.h>

#include "tests/unit/services/runtime/realtime/run_times.h"

namespace fogline {
namespace {

constexpr std::int64_t kSlack = 2;
constexpr std::int64_t kRemembered = 64;

class StepHorizonTest : public testing::Test {
 protected:
  // Passes `count` steps from `first` on. Step k began at 100 ms * k; its message comes `late_ms`
  // later.
  void Hear(std::int64_t first, std::int64_t count, std::int64_t late_ms = 0) {
    for (std::int64_t step = first; step < first + count; ++step) {
      horizon_.Heard(step, At(100 * step + late_ms));
    }
  }
  runtime::StepHorizon horizon_{kPeriod, kSlack, kRemembered* kPeriod};
};

TEST_F(StepHorizonTest, GoesOnWithTheWallClock) {
  EXPECT_FALSE(horizon_.known());
  horizon_.Heard(7, At(700));
  EXPECT_TRUE(horizon_.known());
  EXPECT_EQ(horizon_.Newest(At(799)), 7 + kSlack);
  EXPECT_EQ(horizon_.Newest(At(800)), 8 + kSlack);
  EXPECT_EQ(horizon_.Newest(At(3700)), 37 + kSlack) << "although no message has come meanwhile";
}

TEST_F(StepHorizonTest, IsNotHeldBackByWhatComesLate) {
  Hear(0, 10);
  // GIVEN a second in which only late repeated messages come
  horizon_.Heard(12, At(1950));
  horizon_.Heard(14, At(1955));
  EXPECT_EQ(horizon_.Newest(At(2000)), 20 + kSlack);
}

TEST_F(StepHorizonTest, OpensWithTheFirstMessageThatIsInTimeAfterOneThatWasNot) {
  horizon_.Heard(5, At(2000));
  EXPECT_EQ(horizon_.Newest(At(2000)), 5 + kSlack);
  horizon_.Heard(20, At(2000));
  EXPECT_EQ(horizon_.Newest(At(2100)), 21 + kSlack);
}

TEST_F(StepHorizonTest, IsNotNarrowedByStepsThatAreABitLateEachTime) {
  // Each interval between two messages is 11 ms longer than the period. So the last of the nine
  // messages is 88 ms late. The horizon still counts from step 0, the only step without delay.
  for (std::int64_t k = 0; k < 9; ++k) horizon_.Heard(k, At(111 * k));
  EXPECT_EQ(horizon_.Newest(At(900)), 9 + kSlack);
}

TEST_F(StepHorizonTest, ForgetsThePausesOfTheWorldAndAStepThatNeverWas) {
  Hear(0, 10);
  horizon_.Heard(40, At(1000));
  EXPECT_EQ(horizon_.Newest(At(1000)), 40 + kSlack);
  // Perhaps step 40 is the only step in time, and all other messages are late. So the horizon does
  // not forget step 40 immediately.
  Hear(10, kRemembered - 4, 5);
  EXPECT_GT(horizon_.Newest(At(7000)), 90 + kSlack);
  Hear(10 + kRemembered, kRemembered + 20, 5);
  EXPECT_EQ(horizon_.Newest(At(20'000)), 199 + kSlack);
}

TEST_F(StepHorizonTest, RemembersWhatWasInTimeHoweverMuchIsSentAgain) {
  Hear(0, 10);
  // WHEN the recorder gets all messages that it has requested, 32 steps of nine channels, and each
  // message twice
  for (int i = 0; i < 2 * 32 * 9; ++i) horizon_.Heard(10 + i % 32, At(6000 + i));
  EXPECT_EQ(horizon_.Newest(At(7000)), 70 + kSlack);
}

TEST_F(StepHorizonTest, FollowsAWorldWhoseClockIsFaster) {
  constexpr std::int64_t kSteps = 100'000;
  for (std::int64_t k = 0; k < kSteps; ++k) horizon_.Heard(k, At(99 * k));
  EXPECT_EQ(horizon_.Newest(At(99 * kSteps)), kSteps - 1 + kSlack);
}

// ---- RunHorizon --------------------------------------------------------------------------------

constexpr Duration kLong = 10 * kPeriod;  // after such a silence only the runner's report counts

TEST(RunHorizonTest, IsLimitedByTheRunnerUntilAStepIsHeard) {
  runtime::RunHorizon horizon(kPeriod);
  horizon.Told(50, At(5000));
  // The report may be a second old, which is ten periods. So the run may be ten steps further.
  EXPECT_EQ(horizon.NewestPossible(At(5000), Duration::zero()), 50 + 10 + kSlack);
  EXPECT_EQ(horizon.newest(), -1);
}

TEST(RunHorizonTest, IsLimitedByTheStepsThatAreHeardUnlessThereIsSilence) {
  runtime::RunHorizon horizon(kPeriod);
  horizon.Told(50, At(5000));
  horizon.Heard(48, At(5000));
  EXPECT_EQ(horizon.newest(), 48);
  EXPECT_EQ(horizon.NewestPossible(At(5000), Duration::zero()), 48 + kSlack);
  EXPECT_EQ(horizon.NewestPossible(At(5000), kLong), 50 + 10 + kSlack);
}

TEST(RunHorizonTest, IsNoFurtherThanTheRunnersWordLetsItBe) {
  runtime::RunHorizon horizon(kPeriod);
  horizon.Told(50, At(5000));
  horizon.Heard(1000, At(5000));
  EXPECT_EQ(horizon.NewestPossible(At(5000), Duration::zero()), 50 + 10 + kSlack);
}

}  // namespace
}  // namespace fogline
