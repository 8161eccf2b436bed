#include "services/metrics/detection.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/services/metrics/example_runs.h"

namespace fogline {
namespace {

// A run in clear air. The LiDAR is right, and the automation drives.
std::vector<metrics::Sample> ClearRun(std::size_t steps) {
  std::vector<metrics::Sample> run(steps);
  for (std::size_t k = 0; k < steps; ++k) {
    run[k].time_s = kStep_s * static_cast<double>(k);
    run[k].host_gap_m = run[k].lidar_range_m = run[k].fused_distance_m = 30;
    run[k].threshold = 0.5;
  }
  return run;
}

void Deceive(metrics::Sample& sample) {
  sample.fog_present = true;
  sample.lidar_range_m = sample.fused_distance_m = 29;
}

void GiveToHuman(metrics::Sample& sample) {
  sample.lambda_human = 1;
  sample.lambda_automation = 0;
}

metrics::DetectionMetrics Collect(const std::vector<metrics::Sample>& run,
                                  const Scenario& scenario = {}) {
  metrics::DetectionAccumulator accumulator(scenario);
  for (const metrics::Sample& sample : run) accumulator.Add(sample);
  return accumulator.Result();
}

TEST(DetectionTest, TheHumanIsWrongWhileTheLidarIsRightAndTheAutomationWhileTheTrackIsWrong) {
  auto run = ClearRun(8);
  for (const std::size_t k : {2, 3, 4}) Deceive(run[k]);
  for (const std::size_t k : {4, 5, 7}) GiveToHuman(run[k]);
  const metrics::DetectionMetrics m = Collect(run);
  EXPECT_EQ(m.wrong_automation_s, 2 * kStep_s);  // steps 2 and 3
  EXPECT_EQ(m.wrong_human_s, kStep_s);           // step 5; the last step, 7, has no duration
}

TEST(DetectionTest, AnAlarmInTheFirstStepOfALateLogMayHaveBegunBefore) {
  for (const std::int64_t first : {0, 7}) {
    auto run = ClearRun(4);
    for (std::size_t k = 0; k < run.size(); ++k) {
      run[k].step = first + static_cast<std::int64_t>(k);
      run[k].doc = k == 1 ? 0 : 0.8;  // the alarm falls, and rises again
    }
    const double quiet_s = 3 * kStep_s;
    EXPECT_DOUBLE_EQ(Collect(run).false_alarms_ph.value(), (first == 0 ? 2 : 1) * 3600 / quiet_s);
  }
}

TEST(DetectionTest, AuthorityWeighsTheTime) {
  auto run = ClearRun(3);
  Deceive(run[0]);
  for (metrics::Sample& sample : run) {
    sample.lambda_human = 0.25;
    sample.lambda_automation = 0.75;
  }
  const metrics::DetectionMetrics m = Collect(run);
  EXPECT_EQ(m.wrong_automation_s, 0.75 * kStep_s);
  EXPECT_EQ(m.wrong_human_s, 0.25 * kStep_s);
}

TEST(DetectionTest, AnAutomationWithoutTheDeceivedLidarIsNotWrong) {
  auto run = ClearRun(3);
  for (metrics::Sample& sample : run) {
    Deceive(sample);
    sample.fused_distance_m = 30.05;
  }
  EXPECT_EQ(Collect(run).wrong_automation_s, 0);
}

TEST(DetectionTest, AnAutomationOnAWrongTrackIsWrongAlsoIfTheLidarIsRight) {
  auto run = ClearRun(5);
  run[1].fused_distance_m = 26.05;  // the filter still has an error from the fog
  run[2].fused_distance_m = 29.5;
  run[3].fused_distance_m = 29.95;
  EXPECT_EQ(Collect(run).wrong_automation_s, 2 * kStep_s);
  GiveToHuman(run[1]);
  EXPECT_EQ(Collect(run).wrong_automation_s, kStep_s);
}

TEST(DetectionTest, ALidarIsRightIfItMeasuresNoDistanceAfterACollision) {
  auto run = ClearRun(3);
  for (metrics::Sample& sample : run) {
    sample.host_gap_m = -3;
    sample.lidar_range_m = 0;
    sample.doc = 0.9;
    GiveToHuman(sample);
  }
  for (const double bias_m : {0.0, -0.5}) {  // a range is never below 0
    Scenario scenario;
    scenario.lidar.bias_m = bias_m;
    const metrics::DetectionMetrics m = Collect(run, scenario);
    EXPECT_EQ(m.deception_to_alarm_s, std::nullopt);
    EXPECT_EQ(m.wrong_human_s, 2 * kStep_s);
  }
}

TEST(DetectionTest, ALidarIsRightWithinItsToleranceMountingAndWithoutAValue) {
  Scenario scenario;
  scenario.lidar.bias_m = 0.5;
  scenario.lidar.lateral_offset_m = 1;
  auto run = ClearRun(4);
  run[0].lidar_range_m = 30.5166620396 + 0.09;  // sqrt(30^2 + 1) m + bias of 0.5 m
  run[1].lidar_range_m = 30.5166620396 - 0.09;
  run[2].lidar_range_m = std::numeric_limits<double>::quiet_NaN();
  run[3].lidar_range_m = 30.5166620396;
  for (metrics::Sample& sample : run) {
    GiveToHuman(sample);
    sample.doc = 0.9;
  }
  const metrics::DetectionMetrics m = Collect(run, scenario);
  EXPECT_EQ(m.wrong_human_s, 3 * kStep_s);
  EXPECT_EQ(m.deception_to_alarm_s, std::nullopt);
}

TEST(DetectionTest, DelayIsFromTheFirstDeceptionToTheAlarm) {
  auto run = ClearRun(8);
  for (const std::size_t k : {2, 3, 4, 5}) Deceive(run[k]);
  EXPECT_EQ(Collect(run).deception_to_alarm_s, std::nullopt);
  run[5].doc = 0.5;  // a DoC at the threshold is an alarm
  EXPECT_EQ(Collect(run).deception_to_alarm_s, 3 * kStep_s);
  run[1].doc = run[2].doc = 0.7;  // the alarm is already on
  EXPECT_EQ(Collect(run).deception_to_alarm_s, 0);
}

TEST(DetectionTest, CountsAlarmsThatBeginInClearAirPerHourOfIt) {
  auto run = ClearRun(9);
  for (const std::size_t k : {6, 7}) Deceive(run[k]);
  EXPECT_EQ(Collect(run).false_alarms_ph, 0);
  // One false alarm begins in the first step. Another false alarm lasts a single step. The alarm in
  // fog is correct, although it lasts beyond the fog.
  for (const std::size_t k : {0, 1, 3, 7, 8}) run[k].doc = 0.9;
  EXPECT_EQ(Collect(run).false_alarms_ph, 2 * 3600 / (6 * kStep_s));
}

TEST(DetectionTest, WithoutClearAirThereIsNoRateOfFalseAlarms) {
  auto run = ClearRun(3);
  for (metrics::Sample& sample : run) sample.fog_present = true;
  EXPECT_EQ(Collect(run).false_alarms_ph, std::nullopt);
}

}  // namespace
}  // namespace fogline
