#include "services/runtime/node/runner_watch.h"

#include <gtest/gtest.h>

#include <utility>

namespace fogline {
namespace {

TimePoint At(int at_ms) { return TimePoint{} + milliseconds(1'000'000 + at_ms); }

run_t RunWith(std::int64_t stall_ms) {
  run_t run{};
  run.stall_ms = stall_ms;
  return run;
}

/// Calls Attend() every 100 ms until `to_ms`, as a process does.
void AttendUntil(runtime::RunnerWatch& watch, int from_ms, int to_ms) {
  for (int at_ms = from_ms; at_ms <= to_ms; at_ms += 100) watch.Attend(At(at_ms));
}

TEST(RunnerWatchTest, WaitsForLongerThanTheRunWaitsForAStep) {
  for (const auto& [stall_ms, gone_ms] :
       {std::pair(0, 19'000), std::pair(4000, 19'000), std::pair(60'000, 75'000)}) {
    runtime::RunnerWatch watch(At(0));
    watch.Heard(RunWith(stall_ms), At(0));
    AttendUntil(watch, 0, gone_ms + 100);
    EXPECT_FALSE(watch.Gone(At(gone_ms)));
    EXPECT_TRUE(watch.Gone(At(gone_ms + 1))) << stall_ms;
  }
}

TEST(RunnerWatchTest, HoldsItsOwnPauseAgainstNoRunner) {
  runtime::RunnerWatch watch(At(0));
  watch.Heard(RunWith(4000), At(0));
  watch.Attend(At(100));
  watch.Attend(At(60'100));
  EXPECT_FALSE(watch.Silent(At(60'100)));
  AttendUntil(watch, 60'100, 62'100);
  EXPECT_TRUE(watch.Silent(At(62'100)));
  EXPECT_FALSE(watch.Gone(At(62'100)));
}

TEST(RunnerWatchTest, MissesNoRunnerThatItHasNotHeard) {
  runtime::RunnerWatch watch(At(0));
  AttendUntil(watch, 0, 100'000);
  EXPECT_FALSE(watch.Silent(At(100'000)));
  watch.Heard(RunWith(0), At(100'000));
  watch.Forget();
  AttendUntil(watch, 100'000, 200'000);
  EXPECT_FALSE(watch.Gone(At(200'000)));
}

TEST(SeatInTest, IsAsTheRunSays) {
  run_t run{};
  EXPECT_EQ(runtime::SeatIn(run, "driver", 5), runtime::Seat::kNone);
  run.external = {"acc", "driver"};
  run.holder = {5, 0};
  EXPECT_EQ(runtime::SeatIn(run, "driver", 5), runtime::Seat::kFree);
  EXPECT_EQ(runtime::SeatIn(run, "acc", 5), runtime::Seat::kOurs);
  EXPECT_EQ(runtime::SeatIn(run, "acc", 6), runtime::Seat::kTaken);
}

}  // namespace
}  // namespace fogline
