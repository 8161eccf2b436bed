#include "tools/compare/host_differences.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fogline {
namespace {

metrics::Sample At(double time_s, double speed_mps, double gap_m) {
  metrics::Sample sample;
  sample.time_s = time_s;
  sample.host_speed_mps = speed_mps;
  sample.host_gap_m = gap_m;
  return sample;
}

TEST(CompareStepsTest, TakesTheRecordingAtTheTimeOfTheStepAndInterpolatesBetweenItsRows) {
  const compare::RecordedCar car{.times_s = {{200, 0}, {201, 0}, {202, 0}},
                                 .speeds_mps = {{10, 0}, {20, 0}, {40, 0}},
                                 .gaps_m = {{5, 0}, {6, 0}, {8, 0}},
                                 .leader_mps = {}};
  const std::vector<metrics::Sample> run{At(0, 11, 7), At(0.5, 12, 8), At(1.75, 13, 9)};
  const auto steps = compare::CompareSteps(run, 200, car);
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(steps[0].recorded_speed_mps, 10);
  EXPECT_EQ(steps[1].recorded_speed_mps, 15);
  EXPECT_EQ(steps[2].recorded_speed_mps, 35);
  EXPECT_EQ(steps[2].recorded_gap_m, 7.5);
  EXPECT_EQ(steps[2].time_s, 1.75);
  EXPECT_EQ(steps[2].speed_mps, 13);
  EXPECT_EQ(steps[2].gap_m, 9);
}

TEST(DifferencesTest, AreRunMinusRecording) {
  // Differences of 1, 1 and 4: their mean is 2, the mean of their squares 6.
  const std::vector<compare::ComparedStep> steps{
      {.time_s = 0, .speed_mps = 11, .recorded_speed_mps = 10, .gap_m = 0, .recorded_gap_m = 3},
      {.time_s = 1, .speed_mps = 21, .recorded_speed_mps = 20, .gap_m = 0, .recorded_gap_m = 3},
      {.time_s = 2, .speed_mps = 34, .recorded_speed_mps = 30, .gap_m = 0, .recorded_gap_m = 3}};
  const compare::HostDifferences differences = compare::DifferencesOf(steps);
  const compare::Differences& speed = differences.speed_mps;
  EXPECT_EQ(speed.steps(), 3);
  EXPECT_EQ(speed.mean(), 22);
  EXPECT_EQ(speed.recorded_mean(), 20);
  EXPECT_DOUBLE_EQ(speed.rmse(), std::sqrt(6.0));
  EXPECT_DOUBLE_EQ(speed.spread(), std::sqrt(2.0));
  EXPECT_EQ(speed.largest(), 4);
  // A constant difference has no spread, and its sign does not matter.
  const compare::Differences& gap = differences.gap_m;
  EXPECT_EQ(gap.mean() - gap.recorded_mean(), -3);
  EXPECT_EQ(gap.rmse(), 3);
  EXPECT_EQ(gap.spread(), 0);
  EXPECT_EQ(gap.largest(), 3);
}

}  // namespace
}  // namespace fogline
