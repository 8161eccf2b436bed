#include "services/runtime/realtime/input_health.h"

#include <gtest/gtest.h>

#include "tests/unit/services/runtime/realtime/run_times.h"

namespace fogline {
namespace {

constexpr HealthSection kSection{.stale_periods = 1.5, .lost_periods = 2.5, .recover_steps = 3};

runtime::InputHealth Fresh() { return runtime::InputHealth(kSection, kPeriod, kBegan); }

// An input whose steps 0, 1, ... came at 0, 100, ... ms.
runtime::InputHealth Running(std::int64_t steps) {
  runtime::InputHealth health = Fresh();
  for (std::int64_t k = 0; k < steps; ++k) health.Arrived(k, At(100 * k));
  return health;
}

TEST(InputHealthTest, IsAwaitedAtFirstAndOkWithTheFirstStep) {
  runtime::InputHealth health = Fresh();
  EXPECT_EQ(health.Update(At(250)), InputState::kAwaited);
  health.Arrived(17, At(250));
  EXPECT_EQ(health.state(), InputState::kOk);
  EXPECT_EQ(health.newest(), 17);
}

TEST(InputHealthTest, IsLostIfItNeverCame) {
  runtime::InputHealth health = Fresh();
  EXPECT_EQ(health.Update(At(251)), InputState::kLost);
  EXPECT_EQ(health.newest(), -1);
}

TEST(InputHealthTest, IsStaleThenLostAtTheLimitsWhichAreClosed) {
  runtime::InputHealth health = Running(3);  // the last step came at 200 ms
  EXPECT_EQ(health.Update(At(350)), InputState::kOk);
  EXPECT_EQ(health.Update(At(350) + Duration(1)), InputState::kStale);
  EXPECT_EQ(health.Update(At(450)), InputState::kStale);
  EXPECT_EQ(health.Update(At(450) + Duration(1)), InputState::kLost);
}

TEST(InputHealthTest, FindsASilentInputWithinThreePeriods) {
  runtime::InputHealth health = Running(10);
  EXPECT_EQ(health.Update(At(900 + 300)), InputState::kLost);
  // With the default limits of a scenario, a silent input is also lost within three periods.
  runtime::InputHealth by_default(HealthSection(), kPeriod, kBegan);
  by_default.Arrived(0, At(0));
  EXPECT_EQ(by_default.Update(At(300)), InputState::kLost);
}

TEST(InputHealthTest, DoesNotTakeOneMissingStepForALoss) {
  runtime::InputHealth health = Running(5);
  EXPECT_EQ(health.Update(At(599)), InputState::kStale);
  health.Arrived(6, At(600));
  EXPECT_EQ(health.state(), InputState::kStale);
  for (std::int64_t k = 7; k < 9; ++k) health.Arrived(k, At(100 * k));
  EXPECT_EQ(health.state(), InputState::kOk);
}

TEST(InputHealthTest, SaysWhenItWantsToBeLookedAt) {
  runtime::InputHealth health = Fresh();
  EXPECT_EQ(health.NextChange(), At(250) + Duration(1));
  health.Arrived(0, At(0));
  while (health.state() != InputState::kLost) {
    const InputState before = health.state();
    const TimePoint next = health.NextChange();
    EXPECT_EQ(health.Update(next - Duration(1)), before);
    EXPECT_NE(health.Update(next), before);
  }
  EXPECT_EQ(health.NextChange(), TimePoint::max());
}

TEST(InputHealthTest, NoticesAGapBetweenTwoLooks) {
  runtime::InputHealth health = Running(3);
  health.Arrived(12, At(1200));
  EXPECT_EQ(health.state(), InputState::kLost);
}

TEST(InputHealthTest, IsOkAgainOnlyAfterStepsInTimeOneAfterTheOther) {
  runtime::InputHealth health = Running(3);
  health.Update(At(1000));
  // GIVEN two steps in time and then a late step
  health.Arrived(10, At(1000));
  health.Arrived(11, At(1100));
  health.Arrived(12, At(1251));
  EXPECT_EQ(health.state(), InputState::kLost);
  // THEN the count of steps in time starts again with the late step
  health.Arrived(13, At(1351));
  EXPECT_EQ(health.state(), InputState::kLost);
  health.Arrived(14, At(1451));
  EXPECT_EQ(health.state(), InputState::kOk);
}

TEST(InputHealthTest, DoesNotTakeABacklogForRecovery) {
  runtime::InputHealth health = Running(3);
  health.Update(At(2000));
  for (std::int64_t k = 3; k <= 20; ++k) health.Arrived(k, At(2000));
  EXPECT_EQ(health.state(), InputState::kLost);
  health.Arrived(21, At(2100));
  EXPECT_EQ(health.state(), InputState::kLost);
  health.Arrived(22, At(2200));
  EXPECT_EQ(health.state(), InputState::kOk);
}

TEST(InputHealthTest, CountsLateStepsAndDoesNotUseThem) {
  runtime::InputHealth health = Running(5);
  health.Arrived(2, At(410));
  health.Arrived(3, At(420));
  EXPECT_EQ(health.late(), 2);
  EXPECT_EQ(health.newest(), 4);
  EXPECT_EQ(health.Age(At(430)), milliseconds(30));
}

TEST(InputHealthTest, DoesNotCallAnEqualCopyLate) {
  runtime::InputHealth health = Running(5);
  health.Arrived(4, At(410));
  EXPECT_EQ(health.late(), 0);
  EXPECT_EQ(health.Age(At(430)), milliseconds(30));
}

TEST(InputHealthTest, IsNeverLostBeforeItIsStale) {
  const HealthSection crossed{.stale_periods = 3, .lost_periods = 2, .recover_steps = 1};
  runtime::InputHealth health(crossed, kPeriod, kBegan);
  health.Arrived(0, At(0));
  EXPECT_EQ(health.Update(At(300)), InputState::kOk);
  EXPECT_EQ(health.Update(At(301)), InputState::kLost);
}

TEST(InputHealthTest, MeasuresTheRateAndLetsItFallInSilence) {
  runtime::InputHealth health = Fresh();
  EXPECT_EQ(health.RateHz(At(0)), 0);
  health.Arrived(0, At(0));
  EXPECT_EQ(health.RateHz(At(50)), 0);
  for (std::int64_t k = 1; k < 40; ++k) health.Arrived(k, At(100 * k));
  // The rate is that of the last 15 intervals, which last 0.1 s each. The tolerance is the rounding
  // of one division.
  EXPECT_NEAR(health.RateHz(At(3900)), 10, 1e-12);
  EXPECT_NEAR(health.RateHz(At(4000)), 10, 1e-12);
  // In silence, the time since the last step counts as one more interval: 16 intervals in 1.5 s +
  // 1.7 s.
  EXPECT_NEAR(health.RateHz(At(3900 + 1700)), 5, 1e-12);
}

TEST(InputHealthTest, KnowsTheRateAfterTwoSteps) {
  EXPECT_NEAR(Running(2).RateHz(At(100)), 10, 1e-12);
}

}  // namespace
}  // namespace fogline
