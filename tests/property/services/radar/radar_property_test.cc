// Properties of the radar's errors, over many seeds and steps.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/radar/radar.h"
#include "tests/support/sensor_errors.h"

namespace fogline {
namespace {

using test::ExpectShare;
using test::ExpectStandardNormalMoments;
using test::ExpectUniform;
using test::kRareSigmas;
using test::kSamples;
using test::kSeeds;
using test::kSteps;

truth_t Target(std::int64_t step) {
  truth_t truth{};
  truth.header.step = step;
  truth.host_gap_m = 33.0;
  truth.host_speed_mps = 20.0;
  truth.preceding_speed_mps = 19.0;
  truth.fog_visibility_m = 20000.0;
  return truth;
}

std::vector<radar_t> Measure(Scenario scenario) {
  std::vector<radar_t> measurements;
  for (int seed = 0; seed < kSeeds; ++seed) {
    scenario.seed = seed;
    radar::Radar radar(scenario);
    for (int step = 0; step < kSteps; ++step) measurements.push_back(radar.Step(Target(step)));
  }
  return measurements;
}

TEST(RadarProperty, NoiseHasTheStatedMomentsAroundTheBias) {
  Scenario scenario;
  scenario.radar.bias_m = 0.954;
  scenario.radar.range_std_m = 0.25;
  scenario.radar.range_rate_std_mps = 0.08;
  std::vector<double> range;
  std::vector<double> rate;
  for (const radar_t& radar : Measure(scenario)) {
    range.push_back((radar.range_m - 33.954) / 0.25);
    rate.push_back((radar.range_rate_mps + 1.0) / 0.08);
  }
  ExpectStandardNormalMoments(range);
  ExpectStandardNormalMoments(rate);
  // The noises are independent of each other and from step to step. So the estimated correlations
  // have mean 0 and standard deviation 1 / sqrt(n).
  double cross = 0.0;
  double lag = 0.0;
  for (std::size_t i = 0; i < range.size(); ++i) cross += range[i] * rate[i];
  for (std::size_t i = 1; i < range.size(); ++i) lag += range[i] * range[i - 1];
  EXPECT_LT(std::abs(cross), kRareSigmas * std::sqrt(kSamples));
  EXPECT_LT(std::abs(lag), kRareSigmas * std::sqrt(kSamples));
}

TEST(RadarProperty, NoiseIsGaussian) {
  Scenario scenario;
  scenario.radar.bias_m = 0.0;
  scenario.radar.range_std_m = 0.25;
  std::vector<double> shares;
  for (const radar_t& radar : Measure(scenario)) {
    const double z = (radar.range_m - 33.0) / 0.25;
    shares.push_back(0.5 * std::erfc(-z / std::sqrt(2.0)));
  }
  ExpectUniform(shares);
}

TEST(RadarProperty, DropsOutAtItsRate) {
  for (const double probability : {0.01, 0.3, 0.9}) {
    Scenario scenario;
    scenario.radar.dropout_probability = probability;
    int dropouts = 0;
    for (const radar_t& radar : Measure(scenario)) dropouts += radar.valid ? 0 : 1;
    ExpectShare(dropouts, probability, "dropout");
  }
}

TEST(RadarProperty, NoStepDependsOnAnother) {
  // Each step has its own random draws. These draws do not depend on the steps computed before.
  Scenario scenario;
  scenario.radar.dropout_probability = 0.2;
  radar::Radar forwards(scenario);
  std::vector<radar_t> expected;
  for (int step = 0; step < kSteps; ++step) expected.push_back(forwards.Step(Target(step)));
  radar::Radar backwards(scenario);
  for (int step = kSteps - 1; step >= 0; --step) {
    backwards.Step(Target(step * 7));
    const radar_t& radar = backwards.Step(Target(step));
    const radar_t& same = expected[static_cast<std::size_t>(step)];
    EXPECT_EQ(radar.valid, same.valid);
    EXPECT_EQ(radar.range_m, same.range_m);
    EXPECT_EQ(radar.range_rate_mps, same.range_rate_mps);
  }
}

TEST(RadarProperty, ErrorsDoNotDependOnTheTarget) {
  Scenario scenario;
  radar::Radar radar(scenario);
  for (int step = 0; step < kSteps; ++step) {
    truth_t near = Target(step);
    truth_t far = Target(step);
    far.host_gap_m = 133.0;
    const double at_near = radar.Step(near).range_m - 33.0;
    const double at_far = radar.Step(far).range_m - 133.0;
    EXPECT_NEAR(at_near, at_far, 1e-12);  // the rounding of 133 m
  }
}

TEST(RadarProperty, DetectionEndsOnceWithGrowingDistance) {
  for (const double rain_mmph : {0.0, 1.0, 25.0, 200.0}) {
    for (const double visibility_m : {5.0, 50.0, 1000.0, 20000.0}) {
      Scenario scenario;
      scenario.fog.model = FogModel::kBeam;
      scenario.fog.rain_mmph = rain_mmph;
      radar::Radar radar(scenario);
      bool seen = true;
      for (double gap_m = 1.0; gap_m < 300.0; gap_m += 1.0) {
        truth_t truth = Target(3);
        truth.host_gap_m = gap_m;
        truth.fog_visibility_m = visibility_m;
        const bool sees = radar.Step(truth).valid;
        EXPECT_TRUE(seen || !sees) << gap_m;
        seen = sees;
      }
      EXPECT_FALSE(seen);
    }
  }
}

}  // namespace
}  // namespace fogline
