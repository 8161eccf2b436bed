#include "services/lidar/lidar.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "services/lidar/echo_model.h"
#include "services/visibility.h"

namespace fogline {
namespace {

Scenario Exact(FogModel model) {
  Scenario scenario;
  scenario.fog.model = model;
  scenario.lidar.range_std_m = 0.0;
  return scenario;
}

truth_t Target(double gap_m, double visibility_m = 20000.0, std::int64_t step = 17) {
  truth_t truth{};
  truth.header = {.run_id = 5, .step = step, .utime = step * 100'000};
  truth.host_gap_m = gap_m;
  truth.host_speed_mps = 20.0;
  truth.preceding_speed_mps = 20.0;
  truth.fog_visibility_m = visibility_m;
  return truth;
}

truth_t InFog(double gap_m, double level) {
  truth_t truth = Target(gap_m);
  truth.fog_present = true;
  truth.fog_level = level;
  return truth;
}

TEST(LidarTest, MeasuresTheGapInClearAir) {
  for (const FogModel model : {FogModel::kNone, FogModel::kBias, FogModel::kBeam}) {
    lidar::Lidar lidar(Exact(model));
    const lidar_t& out = lidar.Step(Target(33.0));
    EXPECT_TRUE(out.valid);
    EXPECT_DOUBLE_EQ(out.range_m, 33.0);
  }
}

TEST(LidarTest, AnswersInTheStepOfTheTruth) {
  lidar::Lidar lidar(Exact(FogModel::kNone));
  const lidar_t& out = lidar.Step(Target(33.0));
  EXPECT_EQ(out.header.run_id, 5);
  EXPECT_EQ(out.header.step, 17);
  EXPECT_EQ(out.header.utime, 1'700'000);
}

TEST(LidarTest, SeesALateralOffsetAsASlantRangeAndAddsItsBias) {
  Scenario scenario = Exact(FogModel::kNone);
  scenario.lidar.lateral_offset_m = -3.0;
  scenario.lidar.bias_m = 0.5;
  EXPECT_DOUBLE_EQ(lidar::Lidar(scenario).Step(Target(4.0)).range_m, 5.5);
}

TEST(LidarTest, StatesItsStandardDeviation) {
  Scenario scenario;
  scenario.lidar.range_std_m = 0.03;
  lidar::Lidar lidar(scenario);
  EXPECT_EQ(lidar.Step(Target(33.0)).range_std_m, 0.03);
  EXPECT_EQ(lidar.Step(Target(33.0)).intensity, 1.0);
}

TEST(LidarTest, IsShortByTheBiasTimesTheLevelOfTheFog) {
  Scenario scenario = Exact(FogModel::kBias);
  scenario.fog.bias_m = 0.34;
  lidar::Lidar lidar(scenario);
  EXPECT_DOUBLE_EQ(lidar.Step(InFog(33.0, 0.0)).range_m, 33.0);
  EXPECT_DOUBLE_EQ(lidar.Step(InFog(33.0, 0.5)).range_m, 32.83);
  EXPECT_DOUBLE_EQ(lidar.Step(InFog(33.0, 1.0)).range_m, 32.66);
}

TEST(LidarTest, KnowsNoFogWithoutAFogModel) {
  EXPECT_EQ(lidar::Lidar(Exact(FogModel::kNone)).Step(InFog(33.0, 1.0)).range_m, 33.0);
}

TEST(LidarTest, HasNoEchoFromBeyondItsMaximumRange) {
  for (const FogModel model : {FogModel::kNone, FogModel::kBias, FogModel::kBeam}) {
    Scenario scenario = Exact(model);
    scenario.lidar.max_range_m = 40.0;
    lidar::Lidar lidar(scenario);
    EXPECT_TRUE(lidar.Step(Target(40.0)).valid);
    const lidar_t& out = lidar.Step(Target(40.001));
    EXPECT_FALSE(out.valid);
    EXPECT_EQ(out.header.step, 17);
    EXPECT_EQ(out.range_m, 0.0);
    EXPECT_EQ(out.range_std_m, 0.0);
    EXPECT_EQ(out.intensity, 0.0);
  }
}

TEST(LidarTest, TakesThickFogForACar) {
  // GIVEN: fog of 30 m visibility, which is brighter than a car beyond 16 m
  lidar::Lidar lidar(Exact(FogModel::kBeam));
  for (std::int64_t step = 0; step < 100; ++step) {
    // WHEN: the car is 33 m away
    const lidar_t& out = lidar.Step(Target(33.0, 30.0, step));
    // THEN: the LiDAR reports an echo in the near field, weak but valid
    ASSERT_TRUE(out.valid);
    EXPECT_LT(out.range_m, 8.0);
    EXPECT_GT(out.range_m, 3.0);
    EXPECT_LT(out.intensity, 0.05);
  }
}

TEST(LidarTest, SeesANearCarThroughThickFog) {
  lidar::Lidar lidar(Exact(FogModel::kBeam));
  for (std::int64_t step = 0; step < 100; ++step) {
    EXPECT_DOUBLE_EQ(lidar.Step(Target(8.0, 30.0, step)).range_m, 8.0);
  }
}

TEST(LidarTest, HasNoEchoAtAllOfAFarDarkCarInThinFog) {
  // The echoes of car and fog are 2.4 and 2 standard deviations below the detection threshold. The
  // LiDAR has an echo if at least 8 of its 15 beams are above the threshold. The probability of
  // this is about 1e-9 in a step.
  Scenario scenario = Exact(FogModel::kBeam);
  scenario.lidar.beam.target_reflectivity = 0.02;
  lidar::Lidar lidar(scenario);
  for (std::int64_t step = 0; step < 100; ++step) {
    EXPECT_FALSE(lidar.Step(Target(110.0, 2500.0, step)).valid);
  }
}

TEST(LidarTest, IsBlindBeforeItsBeamsOverlap) {
  lidar::Lidar lidar(Exact(FogModel::kBeam));
  EXPECT_FALSE(lidar.Step(Target(1.9)).valid);
  EXPECT_FALSE(lidar.Step(Target(-1.0, 30.0)).valid);
}

TEST(LidarTest, StatesMoreJitterForAWeakEcho) {
  Scenario scenario;
  scenario.fog.model = FogModel::kBeam;
  scenario.lidar.range_std_m = 0.02;
  lidar::Lidar lidar(scenario);
  const double near = lidar.Step(Target(10.0)).range_std_m;
  const double far = lidar.Step(Target(115.0)).range_std_m;
  EXPECT_GT(near, 0.02);
  EXPECT_LT(near, 0.0202);
  EXPECT_GT(far, near);
  EXPECT_LE(far, 0.02 * std::sqrt(2.0)) << "at the detection threshold";
}

// The variance of a range is range_std_m^2 (1 + 1/SNR), because the time of arrival of a weak echo
// is less exact. The SNR is the power of the echo relative to the detection threshold.
TEST(LidarTest, AddsAVarianceInInverseProportionToThePowerOfTheEcho) {
  Scenario scenario = Exact(FogModel::kBeam);
  scenario.lidar.range_std_m = 0.02;
  scenario.lidar.beam.log_std = 0.0;
  const lidar::EchoModel model(scenario.lidar.beam, ExtinctionOf(20000.0), ExtinctionOf(20000.0));
  lidar::Lidar lidar(scenario);
  for (const double gap_m : {10.0, 60.0, 110.0}) {
    const double power = std::exp(model.At(gap_m, 20000.0).target);
    EXPECT_NEAR(std::pow(lidar.Step(Target(gap_m)).range_std_m / 0.02, 2), 1.0 + 1.0 / power, 1e-12)
        << gap_m;
  }
}

TEST(LidarTest, ReportsATouchForCarsThatOverlap) {
  const lidar_t out = lidar::Lidar(Exact(FogModel::kBias)).Step(InFog(-1.0, 1.0));
  EXPECT_TRUE(out.valid);
  EXPECT_EQ(out.range_m, 0.0);
}

Scenario Modes(const FogModesSection& modes) {
  Scenario scenario = Exact(FogModel::kModes);
  scenario.fog.modes = modes;
  return scenario;
}

TEST(LidarTest, OfPureModesIsBiasedANearEchoOrSilent) {
  lidar::Lidar biased(Modes({.biased_share = 1, .missing_share = 0}));
  lidar::Lidar near_echo(Modes({.near_echo_share = 1, .missing_share = 0}));
  lidar::Lidar missing(Modes({}));
  for (std::int64_t step = 0; step < 100; ++step) {
    truth_t truth = InFog(40.0, 1.0);
    truth.header.step = step;
    truth.fog_visibility_m = 60.0;
    EXPECT_DOUBLE_EQ(biased.Step(truth).range_m, 40.0 - FogSection().bias_m);
    const lidar_t& echo = near_echo.Step(truth);
    ASSERT_TRUE(echo.valid);
    EXPECT_GT(echo.range_m, 3.0);
    EXPECT_LT(echo.range_m, 9.0);
    EXPECT_GT(echo.intensity, 0.0);
    EXPECT_LT(echo.intensity, 0.05);
    EXPECT_FALSE(missing.Step(truth).valid);
  }
}

TEST(LidarTest, MissesNoNearCarAndEveryFarOne) {
  lidar::Lidar lidar(Modes({}));
  int seen = 0;
  for (std::int64_t step = 0; step < 1000; ++step) {
    truth_t truth = InFog(25.0, 1.0);
    truth.header.step = step;
    EXPECT_EQ(lidar.Step(truth).range_m, 25.0);
    truth.host_gap_m = 35.0;
    EXPECT_FALSE(lidar.Step(truth).valid);
    truth.host_gap_m = 30.0;
    if (lidar.Step(truth).valid) ++seen;
  }
  EXPECT_NEAR(seen, 500, 80) << "half way: 5 standard deviations";
}

TEST(LidarTest, OfModesIsRightInClearAir) {
  for (const FogModesSection& modes :
       {FogModesSection{},
        FogModesSection{.biased_share = 0.5, .near_echo_share = 0.5, .missing_share = 0}}) {
    lidar::Lidar lidar(Modes(modes));
    for (std::int64_t step = 0; step < 100; ++step) {
      EXPECT_EQ(lidar.Step(Target(60.0, 20000.0, step)).range_m, 60.0);
    }
  }
}

TEST(LidarTest, OfModesHasNoEchoOfACarBeyondItsMaximumRange) {
  Scenario scenario = Modes({.biased_share = 1, .missing_share = 0});
  scenario.lidar.max_range_m = 40.0;
  lidar::Lidar lidar(scenario);
  EXPECT_FALSE(lidar.Step(InFog(40.001, 1.0)).valid);
  EXPECT_FALSE(lidar.Step(InFog(40.001, 0.0)).valid);
}

TEST(LidarTest, OfANearEchoSeesNothingBehindTheCar) {
  lidar::Lidar lidar(Modes({.near_echo_share = 1, .missing_share = 0}));
  for (double gap_m = -1.0; gap_m < 6.0; gap_m += 0.25) {
    truth_t truth = InFog(gap_m, 1.0);
    truth.fog_visibility_m = 60.0;
    const lidar_t& out = lidar.Step(truth);
    EXPECT_TRUE(out.valid);
    EXPECT_LE(out.range_m, std::max(0.0, gap_m));
    EXPECT_TRUE(std::isfinite(out.intensity)) << gap_m;
  }
}

TEST(LidarTest, NoDrawServesTwoPurposes) {
  std::set<std::uint32_t> draws;
  for (const std::uint32_t draw : {lidar::Lidar::kNoiseDraw, lidar::Lidar::kDropoutDraw,
                                   lidar::Lidar::kModeDraw, lidar::Lidar::kModeScatterDraw}) {
    EXPECT_TRUE(draws.insert(draw).second);
  }
  draws.clear();  // the other stream has draws of its own
  constexpr std::uint32_t kMaxBeams = 101;
  for (std::uint32_t n = 0; n < kMaxBeams; ++n) {
    EXPECT_TRUE(draws.insert(lidar::Lidar::PowerDraw(n)).second);
    EXPECT_TRUE(draws.insert(lidar::Lidar::ScatterDraw(n)).second);
  }
}

TEST(LidarTest, DropsOutAlwaysAtProbabilityOne) {
  Scenario scenario = Exact(FogModel::kBeam);
  scenario.lidar.dropout_probability = 1.0;
  lidar::Lidar lidar(scenario);
  for (std::int64_t step = 0; step < 1000; ++step) {
    EXPECT_FALSE(lidar.Step(Target(33.0, 30.0, step)).valid);
  }
}

}  // namespace
}  // namespace fogline
