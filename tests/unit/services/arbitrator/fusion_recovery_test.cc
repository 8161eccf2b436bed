#include "services/arbitrator/fusion_recovery.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr double kError_m = 0.5;
constexpr int kSteps = 3;  // steps of 0.1 s

Scenario WithLimits() {
  Scenario scenario;
  scenario.arbitrator.transfer.hand_back_error_m = kError_m;
  scenario.arbitrator.transfer.hand_back_s = 0.1 * kSteps;
  return scenario;
}

class FusionRecoveryTest : public testing::Test {
 protected:
  FusionRecoveryTest() {
    track_.valid = radar_.valid = lidar_.valid = 1;
    track_.state[0] = radar_.range_m = lidar_.range_m = 30;
  }
  /// Takes one more step. @return whether the track has recovered
  bool Observe() {
    recovery_.Observe(radar_, lidar_, track_);
    return recovery_.recovered();
  }
  void Recover() {
    for (int i = 0; i < kSteps; ++i) Observe();
    ASSERT_TRUE(recovery_.recovered());
  }

  radar_t radar_{};
  lidar_t lidar_{};
  track_t track_{};
  arbitrator::FusionRecovery recovery_{WithLimits()};
};

TEST_F(FusionRecoveryTest, TakesItsTimeWithoutABreak) {
  EXPECT_FALSE(Observe());
  EXPECT_FALSE(Observe());
  EXPECT_TRUE(Observe());
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(Observe());
  track_.state[0] = 31;
  EXPECT_FALSE(Observe());
  track_.state[0] = 30;
  EXPECT_FALSE(Observe());
  EXPECT_FALSE(Observe());
  EXPECT_TRUE(Observe());
}

TEST_F(FusionRecoveryTest, AsksEachSensorThatIsThere) {
  Recover();
  radar_.range_m = 31;
  EXPECT_FALSE(Observe());
  radar_.valid = 0;
  Recover();
  lidar_.range_m = 29;
  EXPECT_FALSE(Observe());
}

TEST_F(FusionRecoveryTest, DoesNotTakeSilenceForAgreement) {
  Recover();
  radar_.valid = lidar_.valid = 0;
  EXPECT_FALSE(Observe());
}

TEST_F(FusionRecoveryTest, NeedsATrackOfTheSameStep) {
  Recover();
  track_.valid = 0;
  EXPECT_FALSE(Observe());
  track_.valid = 1;
  Recover();
  radar_.header.step = lidar_.header.step = 5;
  EXPECT_FALSE(Observe());
  track_.header.step = 5;
  Recover();
}

TEST_F(FusionRecoveryTest, CountsTheLimitItselfAsAgreement) {
  radar_.range_m = 30 + kError_m;
  lidar_.range_m = 30 - kError_m;
  Recover();
  lidar_.range_m = std::nextafter(30 - kError_m, 0);
  EXPECT_FALSE(Observe());
}

// A target 4 m ahead and 3 m to the side has a range of 5 m.
TEST(FusionRecoveryOfSensorsTest, BesideTheLaneComparesAlongTheirLineOfSight) {
  Scenario scenario = WithLimits();
  scenario.radar.lateral_offset_m = 3;
  scenario.lidar.lateral_offset_m = -3;
  arbitrator::FusionRecovery recovery(scenario);
  radar_t radar{};
  lidar_t lidar{};
  track_t track{};
  track.valid = radar.valid = lidar.valid = 1;
  track.state[0] = 4;
  radar.range_m = lidar.range_m = 5;
  for (int i = 0; i < kSteps; ++i) recovery.Observe(radar, lidar, track);
  EXPECT_TRUE(recovery.recovered());
}

}  // namespace
}  // namespace fogline
