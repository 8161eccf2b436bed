#include "services/metrics/track/track_judge.h"

#include <limits>

#include <gtest/gtest.h>

namespace fogline {
namespace {

metrics::Sample Track(double error_m) {
  metrics::Sample sample;
  sample.host_gap_m = 30;
  sample.fused_distance_m = 30 + error_m;
  return sample;
}

// A scenario with a radar whose ranges are 0.8 m too long. In the filter, the radar's ranges have a
// quarter of the weight of the LiDAR's ranges.
Scenario Biased(double radar_bias_m = 0.8, double lidar_bias_m = 0) {
  Scenario scenario;
  scenario.radar.bias_m = radar_bias_m;
  scenario.lidar.bias_m = lidar_bias_m;
  scenario.fusion.radar_range_std_m = 0.1;
  scenario.fusion.lidar_range_std_m = 0.05;
  scenario.measures.lidar_tolerance_m = 0.1;
  return scenario;
}

TEST(TrackJudgeTest, OffsetsCountByTheNoiseThatTheFilterAssumes) {
  EXPECT_NEAR(metrics::ErrorOfOffsets(Biased()), 0.16, 1e-12);
  EXPECT_NEAR(metrics::ErrorOfOffsets(Biased(0.8, -0.7)), 0.16 - 0.56, 1e-12);
  EXPECT_NEAR(metrics::ErrorOfOffsets(Scenario{}), 0.477, 1e-12);  // equal weights
}

TEST(TrackJudgeTest, ATrackIsRightBetweenTheTruthAndTheDistanceOfClearAir) {
  const metrics::TrackJudge judge(Biased());
  for (const double error_m : {-0.0999, 0.0, 0.16, 0.2599}) {
    EXPECT_FALSE(judge.IsWrong(Track(error_m))) << error_m;
  }
  for (const double error_m : {-30.0, -0.1001, 0.2601, 0.8}) {
    EXPECT_TRUE(judge.IsWrong(Track(error_m))) << error_m;
  }
}

TEST(TrackJudgeTest, AnOffsetMayMakeTheTrackShort) {
  const metrics::TrackJudge judge(Biased(-0.8));
  EXPECT_FALSE(judge.IsWrong(Track(-0.2599)));
  EXPECT_FALSE(judge.IsWrong(Track(0.0999)));
  EXPECT_TRUE(judge.IsWrong(Track(-0.2601)));
  EXPECT_TRUE(judge.IsWrong(Track(0.1001)));
}

TEST(TrackJudgeTest, WithoutATrackNothingIsWrong) {
  const metrics::TrackJudge judge(Biased());
  EXPECT_FALSE(judge.IsWrong(Track(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace fogline
