#include "services/fusion/fusion.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/find_row.h"
#include "tests/unit/services/fusion/fusion_messages.h"

namespace fogline::test {
namespace {

constexpr double kNear = 1e-12;  // some roundings of values up to 100

Scenario Gated() {
  Scenario scenario;
  scenario.fusion.gating = true;
  return scenario;
}

TEST(FusionTest, CopiesTheHeader) {
  fusion::Fusion fusion{Scenario()};
  const track_t& track = Step(fusion, At(3));
  EXPECT_EQ(track.header.run_id, 7);
  EXPECT_EQ(track.header.step, 3);
  EXPECT_EQ(track.header.utime, 300'000);
}

TEST(FusionTest, HasNoTrackBeforeTheFirstMeasurement) {
  fusion::Fusion fusion{Scenario()};
  Messages m = At(0);
  m.radar.valid = m.lidar.valid = 0;
  const track_t& track = Step(fusion, m);
  EXPECT_FALSE(track.valid);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(track.state[i], 0);
    EXPECT_EQ(track.covariance[i][i], 0);
    EXPECT_EQ(track.usage[i], track_t::ABSENT);
  }
}

TEST(FusionTest, PredictsAcrossStepsThatWereLeftOut) {
  for (const double host_mps2 : {0.0, -2.0}) {
    SCOPED_TRACE(host_mps2);
    fusion::Fusion fusion{Scenario()};
    for (std::int64_t step = 0; step <= 20; ++step) {
      Messages m = At(step, 60 - static_cast<double>(step), -10);
      m.ego.speed_mps = 20;
      Step(fusion, m);
    }
    // The host brakes in the 0.2 s from step 20 to step 22.
    Messages m = At(22, 38 - host_mps2 * 0.02, -10 - host_mps2 * 0.2);
    m.ego.speed_mps = 20 + host_mps2 * 0.2;
    m.ego.acceleration_mps2 = host_mps2;
    const track_t& track = Step(fusion, m);
    EXPECT_NEAR(track.innovation[0], 0, 1e-6);
    EXPECT_NEAR(track.innovation[1], 0, 1e-6);
  }
}

TEST(FusionTest, StartsWithTheRadarsValuesAndTheirNoise) {
  Scenario scenario;
  scenario.fusion.radar_range_std_m = 0.3;
  scenario.fusion.radar_range_rate_std_mps = 0.2;
  scenario.fusion.initial_acceleration_std_mps2 = 0.7;
  fusion::Fusion fusion(scenario);
  Messages m = At(0, 40, -2);
  m.lidar.valid = 0;
  const track_t& track = Step(fusion, m);
  EXPECT_TRUE(track.valid);
  EXPECT_EQ(track.state[0], 40);
  EXPECT_EQ(track.state[1], -2);
  EXPECT_EQ(track.state[2], 0);
  EXPECT_NEAR(track.covariance[0][0], 0.09, kNear);
  EXPECT_NEAR(track.covariance[1][1], 0.04, kNear);
  EXPECT_NEAR(track.covariance[2][2], 0.49, kNear);
  EXPECT_EQ(track.covariance[0][1], 0);
  EXPECT_EQ(track.usage[0], track_t::USED);
  EXPECT_EQ(track.usage[1], track_t::USED);
  EXPECT_EQ(track.usage[2], track_t::ABSENT);
}

TEST(FusionTest, StartsWithTheLidarWhereTheRadarIsBlind) {
  Scenario scenario;
  scenario.fusion.lidar_range_std_m = 0.1;
  scenario.fusion.initial_speed_std_mps = 3;
  fusion::Fusion fusion(scenario);
  Messages m = At(0, 40, -2);
  m.radar.valid = 0;
  const track_t& track = Step(fusion, m);
  EXPECT_TRUE(track.valid);
  EXPECT_EQ(track.state[0], 40);
  EXPECT_EQ(track.state[1], 0);
  EXPECT_NEAR(track.covariance[0][0], 0.01, kNear);
  EXPECT_NEAR(track.covariance[1][1], 9, kNear);
  EXPECT_EQ(track.usage[0], track_t::ABSENT);
  EXPECT_EQ(track.usage[2], track_t::USED);
}

TEST(FusionTest, FirstLidarValueCorrectsTheRadarsStart) {
  Scenario scenario;
  scenario.fusion.radar_range_std_m = 0.3;
  scenario.fusion.lidar_range_std_m = 0.1;
  fusion::Fusion fusion(scenario);
  Messages m = At(0, 40);
  m.lidar.range_m = 39;
  const track_t& track = Step(fusion, m);
  // The weights of radar and LiDAR are the inverse variances, 1 : 9.
  EXPECT_NEAR(track.state[0], (40 + 9 * 39) / 10.0, kNear);
  EXPECT_NEAR(track.covariance[0][0], 0.009, kNear);
  EXPECT_EQ(track.innovation[2], -1);
  EXPECT_NEAR(track.innovation_variance[2], 0.10, kNear);
}

TEST(FusionTest, StartsBesideTheLaneWithWhatTheTwoValuesSayOfTheDistance) {
  Scenario scenario;
  scenario.radar.lateral_offset_m = 2.5;
  scenario.fusion.radar_range_std_m = 0.12;
  fusion::Fusion fusion(scenario);
  Messages m = At(0, 6.5, -1.2);
  m.lidar.valid = 0;
  const track_t& track = Step(fusion, m);
  // The lateral offset of 2.5 m, the distance of 6 m and the range of 6.5 m form a right triangle.
  // The cosine of the direction to the target is 12/13.
  EXPECT_NEAR(track.state[0], 6.0, kNear);
  EXPECT_NEAR(track.state[1], -1.3, kNear);
  EXPECT_NEAR(track.covariance[0][0], 0.13 * 0.13, kNear);
  EXPECT_NE(track.covariance[0][1], 0);  // so the range helps to interpret the range rate
}

// The range rate depends on the direction to the target, and the range has the better information
// about this direction.
TEST(FusionTest, CorrectsByTheRangeBeforeTheRangeRate) {
  Scenario scenario;
  scenario.radar.lateral_offset_m = 2.5;
  const auto second_step = [&](double range_m, double range_rate_mps) {
    fusion::Fusion fusion(scenario);
    Step(fusion, At(0, 6.5, -1.2));
    Messages m = At(1, range_m, range_rate_mps);
    m.lidar.valid = 0;
    return Step(fusion, m);
  };
  const track_t track = second_step(6.4, -1.2);
  EXPECT_EQ(second_step(6.4, -1.8).innovation[0], track.innovation[0]);
  EXPECT_NE(second_step(6.6, -1.2).innovation[1], track.innovation[1]);
}

TEST(FusionTest, CorrectsByEachSensorAlongItsOwnLineOfSight) {
  // GIVEN a target 4 m ahead of the radar, and a LiDAR 3 m beside the lane
  Scenario scenario;
  scenario.lidar.lateral_offset_m = 3;
  fusion::Fusion fusion(scenario);
  for (int k = 0; k < 2; ++k) {
    // WHEN the LiDAR measures the slant range of this target, 5 m
    Messages m = At(k, 4);
    m.lidar.range_m = 5;
    const track_t& track = Step(fusion, m);
    // THEN the two sensors agree
    EXPECT_NEAR(track.state[0], 4, kNear);
    EXPECT_NEAR(track.innovation[0], 0, kNear);
    EXPECT_NEAR(track.innovation[2], 0, kNear);
  }
}

TEST(FusionTest, DoesNotStartOnATargetBesideTheSensor) {
  Scenario scenario;
  scenario.radar.lateral_offset_m = 3;
  scenario.lidar.lateral_offset_m = -3;
  fusion::Fusion fusion(scenario);
  const track_t& track = Step(fusion, At(0, 5.9));
  EXPECT_FALSE(track.valid);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(track.usage[i], track_t::GATED);
  EXPECT_TRUE(Step(fusion, At(1, 6.1)).valid);
}

TEST(FusionTest, ReportsTheAccelerationRelativeToTheHosts) {
  fusion::Fusion fusion{Scenario()};
  Step(fusion, At(0));
  Messages m = At(1, 30 + 0.5 * 2 * 0.01, 0.2);
  m.ego.acceleration_mps2 = -2;  // the car ahead does not accelerate: no innovation
  const track_t& track = Step(fusion, m);
  EXPECT_NEAR(track.state[2], 2, kNear);
  EXPECT_NEAR(track.state[1], 0.2, kNear);
  EXPECT_NEAR(track.state[0], 30.01, kNear);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(track.innovation[i], 0, kNear);
}

TEST(FusionTest, GrowsUncertainWhileBothSensorsAreSilent) {
  fusion::Fusion fusion{Scenario()};
  double last = Step(fusion, At(0, 30, -1)).covariance[0][0];
  for (int k = 1; k <= 50; ++k) {
    Messages m = At(k);
    m.radar.valid = m.lidar.valid = 0;
    const track_t& track = Step(fusion, m);
    EXPECT_TRUE(track.valid);
    EXPECT_NEAR(track.state[0], 30 - 0.1 * k, 1e-10);
    EXPECT_GT(track.covariance[0][0], last);
    last = track.covariance[0][0];
  }
}

TEST(FusionTest, IgnoresWhatTheSensorsSayOfTheirOwnPrecision) {
  fusion::Fusion one{Scenario()};
  fusion::Fusion other{Scenario()};
  for (int k = 0; k < 20; ++k) {
    Messages m = At(k, 30 + std::sin(k), std::cos(k));
    const track_t& a = Step(one, m);
    m.radar.range_std_m = 7;
    m.radar.range_rate_std_mps = 8;
    m.lidar.range_std_m = 9;
    m.lidar.intensity = 0.01;
    ExpectSameEstimate(a, Step(other, m));
  }
}

TEST(FusionTest, BelievesADeceivedLidarWhenNotGated) {
  fusion::Fusion fusion{Scenario()};
  Step(fusion, At(0));
  Messages m = At(1);
  m.lidar.range_m = 4;
  const track_t& track = Step(fusion, m);
  EXPECT_EQ(track.usage[2], track_t::USED);
  EXPECT_LT(track.state[0], 25);
}

TEST(FusionTest, RefusedValueLeavesTheEstimateAsIfItWereMissing) {
  fusion::Fusion gated(Gated());
  fusion::Fusion blind(Gated());
  for (int k = 0; k < 30; ++k) {
    Step(gated, At(k));
    Step(blind, At(k));
  }
  // GIVEN a LiDAR value that the fog makes 26 m too short
  Messages deceived = At(30);
  deceived.lidar.range_m = 4;
  Messages missing = At(30);
  missing.lidar.valid = 0;
  // WHEN the value reaches the gate
  const track_t& a = Step(gated, deceived);
  const track_t& b = Step(blind, missing);
  // THEN the track marks the value and reports its innovation, but does not use the value
  EXPECT_EQ(a.usage[2], track_t::GATED);
  EXPECT_NEAR(a.innovation[2], -26, 1e-9);
  EXPECT_GT(a.innovation_variance[2], 0);
  ExpectSameEstimate(a, b);
}

TEST(FusionTest, FollowsAnotherCarThatCutsInOnceTheGateReopens) {
  const Scenario scenario = Gated();
  fusion::Fusion fusion(scenario);
  int k = 0;
  for (; k < 30; ++k) Step(fusion, At(k, 40));
  // GIVEN a car that cuts in, 15 m nearer and with the same speed
  // WHEN the gate has refused the new distance for `gate_reopen_after` steps
  for (int i = 0; i < scenario.fusion.gate_reopen_after; ++i, ++k) {
    const track_t& track = Step(fusion, At(k, 25));
    EXPECT_EQ(track.usage[0], track_t::GATED);
    EXPECT_EQ(track.usage[1], track_t::USED);
    EXPECT_EQ(track.usage[2], track_t::GATED);
    EXPECT_NEAR(track.state[0], 40, 1e-9);
  }
  EXPECT_EQ(Step(fusion, At(k, 25)).usage[0], track_t::USED);
  // THEN the estimate converges to the new distance
  for (int i = 0; i < 60; ++i) Step(fusion, At(++k, 25));
  const track_t& settled = Step(fusion, At(++k, 25));
  EXPECT_NEAR(settled.state[0], 25, 0.05);  // one standard deviation of a range
  for (int i = 0; i < 3; ++i) EXPECT_EQ(settled.usage[i], track_t::USED);
}

TEST(FusionTest, KeepsItsCarForeverBehindAGateThatNeverReopens) {
  Scenario scenario = Gated();
  scenario.fusion.gate_reopen_after = 0;
  fusion::Fusion fusion(scenario);
  int k = 0;
  for (; k < 30; ++k) Step(fusion, At(k, 40));
  // GIVEN a LiDAR that only has echoes of the fog WHEN it measures 4 m for a minute
  for (int i = 0; i < 600; ++i) {
    Messages m = At(k++, 40);
    m.lidar.range_m = 4;
    const track_t& track = Step(fusion, m);
    // THEN the track follows the radar alone
    ASSERT_EQ(track.usage[2], track_t::GATED) << i;
    ASSERT_NEAR(track.state[0], 40, 1e-9) << i;
  }
}

TEST(FusionTest, ComesBackFromAnEstimateBehindTheSensor) {
  Scenario scenario;
  scenario.radar.lateral_offset_m = 1.0;
  scenario.lidar.lateral_offset_m = -1.0;
  fusion::Fusion fusion(scenario);
  // GIVEN an approach at 10 m/s, and sensors without values until the estimate has passed the
  // target
  Step(fusion, At(0, 20, -10));
  int k = 1;
  for (; k < 30; ++k) {
    Messages m = At(k);
    m.radar.valid = m.lidar.valid = 0;
    Step(fusion, m);
  }
  // WHEN a measurement shows that the target kept its distance
  const double range = std::hypot(15.0, 1.0);
  for (int i = 0; i < 50; ++i) Step(fusion, At(k++, range, 0));
  // THEN the estimate is in front of the host again
  EXPECT_NEAR(Step(fusion, At(k, range, 0)).state[0], 15, 0.05);
}

// ---- adaptive noise -----------------------------------------------------------------------------

Scenario Adapting(NoiseAdaptation rule) {
  Scenario scenario;
  scenario.fusion.adaptive_noise = rule;
  return scenario;
}

constexpr NoiseAdaptation kAdapting[]{NoiseAdaptation::kInnovation, NoiseAdaptation::kResidual};

// The variance of an innovation contains the noise that was estimated from earlier values, and not
// the noise that is estimated from the present value.
TEST(FusionTest, UsesAnAdaptedNoiseFromTheNextStepOn) {
  for (const NoiseAdaptation rule : kAdapting) {
    fusion::Fusion plain{Scenario()};
    fusion::Fusion adapting(Adapting(rule));
    for (int k = 0; k < 20; ++k) ExpectSameEstimate(Step(plain, At(k)), Step(adapting, At(k)));
    Messages m = At(20);
    m.lidar.range_m = 4;
    const track_t first = Step(adapting, m);
    ExpectSameEstimate(Step(plain, m), first);
    m = At(21);
    m.lidar.range_m = 4;
    EXPECT_GT(Step(adapting, m).innovation_variance[2], 100) << "0.7 times 26 m squared";
    EXPECT_LT(first.innovation_variance[2], 0.1);
  }
}

// The residual is the part of an innovation that remains after the correction.
TEST(FusionTest, LearnsTheNoiseFromTheResidualAfterTheCorrection) {
  const Scenario scenario = Adapting(NoiseAdaptation::kResidual);
  const double assumed = scenario.fusion.lidar_range_std_m * scenario.fusion.lidar_range_std_m;
  fusion::Fusion plain{Scenario()};
  fusion::Fusion adapting(scenario);
  for (int k = 0; k < 20; ++k) {
    Step(plain, At(k));
    Step(adapting, At(k));
  }
  // GIVEN an innovation d of variance S = P + R, with the variance P of the predicted range and the
  // assumed noise variance R
  Messages m = At(20);
  m.lidar.range_m = 31;
  Step(plain, m);
  const track_t& before = Step(adapting, m);
  const double variance = before.innovation_variance[2];
  // WHEN the noise is learned from the residual d R / S and from the variance of the corrected
  // range, P R / S
  const double share = assumed / variance;
  const double residual = before.innovation[2] * share;
  const double seen = residual * residual + (variance - assumed) * share;
  const double forgetting = scenario.fusion.noise_forgetting;
  const double learned = forgetting * assumed + (1 - forgetting) * seen;
  // THEN the next innovation has this noise
  m = At(21);
  const double added =
      Step(adapting, m).innovation_variance[2] - Step(plain, m).innovation_variance[2];
  EXPECT_GT(learned, 2 * assumed);
  EXPECT_NEAR(added, learned - assumed, 1e-9);
}

TEST(FusionTest, SoonDisbelievesADeceivedLidarIfItsNoiseAdapts) {
  for (const NoiseAdaptation rule : kAdapting) {
    fusion::Fusion plain{Scenario()};
    fusion::Fusion adapting(Adapting(rule));
    int k = 0;
    for (; k < 20; ++k) {
      Step(plain, At(k));
      Step(adapting, At(k));
    }
    double plain_error_m = 0;
    double error_m = 0;
    for (int i = 0; i < 50; ++i, ++k) {
      Messages m = At(k);
      m.lidar.range_m = 4;
      plain_error_m = std::abs(Step(plain, m).state[0] - 30);
      error_m = std::abs(Step(adapting, m).state[0] - 30);
    }
    EXPECT_GT(plain_error_m, 10) << "equal noises: in the middle of the two sensors";
    EXPECT_LT(error_m, 1);
  }
}

TEST(FusionTest, AValueThatCorrectsNothingAdaptsNoNoise) {
  for (const NoiseAdaptation rule : kAdapting) {
    Scenario gated = Adapting(rule);
    gated.fusion.gating = true;
    gated.fusion.gate_reopen_after = 0;
    Scenario isolating = Adapting(rule);
    isolating.arbitrator.policy = FindPolicy("isolate").value();
    for (const Scenario& scenario : {gated, isolating}) {
      fusion::Fusion fusion(scenario);
      int k = 0;
      for (; k < 30; ++k) Step(fusion, At(k));
      for (int i = 0; i < 20; ++i, ++k) {
        Messages m = At(k);
        m.lidar.range_m = 4;
        const track_t& track = Step(fusion, m);
        ASSERT_NE(track.usage[2], track_t::USED);
        ASSERT_LT(track.innovation_variance[2], 0.1) << "the noise is the assumed one";
      }
    }
  }
}

}  // namespace
}  // namespace fogline::test
