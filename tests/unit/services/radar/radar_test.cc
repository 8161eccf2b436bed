#include "services/radar/radar.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fogline {
namespace {

// A radar without errors, so that only the geometry matters.
Scenario Exact() {
  Scenario scenario;
  scenario.radar.bias_m = 0.0;
  scenario.radar.range_std_m = 0.0;
  scenario.radar.range_rate_std_mps = 0.0;
  return scenario;
}

truth_t Target(double gap_m, double relative_speed_mps = 0.0) {
  truth_t truth{};
  truth.header = {.run_id = 5, .step = 17, .utime = 1'700'000};
  truth.host_gap_m = gap_m;
  truth.host_speed_mps = 20.0;
  truth.preceding_speed_mps = 20.0 + relative_speed_mps;
  truth.fog_visibility_m = 20000.0;
  return truth;
}

TEST(RadarTest, MeasuresTheGapAndItsRate) {
  radar::Radar radar(Exact());
  const radar_t& out = radar.Step(Target(33.0, -2.0));
  EXPECT_TRUE(out.valid);
  EXPECT_EQ(out.range_m, 33.0);
  EXPECT_EQ(out.range_rate_mps, -2.0) << "negative: closing";
}

TEST(RadarTest, AnswersInTheStepOfTheTruth) {
  radar::Radar radar(Exact());
  const radar_t& out = radar.Step(Target(33.0));
  EXPECT_EQ(out.header.run_id, 5);
  EXPECT_EQ(out.header.step, 17);
  EXPECT_EQ(out.header.utime, 1'700'000);
}

TEST(RadarTest, SeesALateralOffsetAsASlantRange) {
  Scenario scenario = Exact();
  scenario.radar.lateral_offset_m = 3.0;
  radar::Radar radar(scenario);
  const radar_t& out = radar.Step(Target(4.0, -2.0));
  EXPECT_DOUBLE_EQ(out.range_m, 5.0);
  EXPECT_DOUBLE_EQ(out.range_rate_mps, -2.0 * 4.0 / 5.0);
}

TEST(RadarTest, AddsItsBias) {
  Scenario scenario = Exact();
  scenario.radar.bias_m = 0.954;
  EXPECT_DOUBLE_EQ(radar::Radar(scenario).Step(Target(33.0)).range_m, 33.954);
}

TEST(RadarTest, StatesItsStandardDeviations) {
  Scenario scenario;
  scenario.radar.range_std_m = 0.3;
  scenario.radar.range_rate_std_mps = 0.07;
  radar::Radar radar(scenario);
  const radar_t& out = radar.Step(Target(33.0));
  EXPECT_EQ(out.range_std_m, 0.3);
  EXPECT_EQ(out.range_rate_std_mps, 0.07);
}

TEST(RadarTest, DropsTheTargetBeyondMaximumRange) {
  Scenario scenario = Exact();
  scenario.radar.max_range_m = 100.0;
  radar::Radar radar(scenario);
  EXPECT_TRUE(radar.Step(Target(100.0)).valid);
  const radar_t& out = radar.Step(Target(100.001, -2.0));
  EXPECT_FALSE(out.valid);
  EXPECT_EQ(out.header.step, 17);
  EXPECT_EQ(out.range_m, 0.0);
  EXPECT_EQ(out.range_rate_mps, 0.0);
  EXPECT_EQ(out.range_std_m, 0.0);
  EXPECT_EQ(out.range_rate_std_mps, 0.0);
}

TEST(RadarTest, ComparesItsMaximumRangeWithTheSlantRange) {
  Scenario scenario = Exact();
  scenario.radar.max_range_m = 5.0;
  scenario.radar.lateral_offset_m = 3.0;
  radar::Radar radar(scenario);
  EXPECT_TRUE(radar.Step(Target(3.999)).valid);
  EXPECT_FALSE(radar.Step(Target(4.001)).valid);
}

TEST(RadarTest, LosesRangeInHeavyRain) {
  // Rain of 50 mm/h attenuates by 18.76 dB/km. This is 6.45 dB to 172 m and back, and 6.49 dB to
  // 173 m and back. A distance R below the clear range of 250 m gains 40 log10(250 / R): 6.50 dB at
  // 172 m, 6.40 dB at 173 m. So the radar detects the target at 172 m, and does not detect it at
  // 173 m.
  Scenario scenario = Exact();
  scenario.fog.rain_mmph = 50.0;
  radar::Radar radar(scenario);
  EXPECT_TRUE(radar.Step(Target(172.0)).valid);
  EXPECT_FALSE(radar.Step(Target(173.0)).valid);
}

TEST(RadarTest, BarelyNoticesThickFogUnderModelBeam) {
  // GIVEN: fog of 50 m visibility, 1.57 dB/km, which reduces the range from 250 m to 239.4 m
  Scenario scenario = Exact();
  scenario.fog.model = FogModel::kBeam;
  truth_t near = Target(238.0);
  near.fog_visibility_m = 50.0;
  truth_t far = Target(241.0);
  far.fog_visibility_m = 50.0;
  radar::Radar radar(scenario);
  // THEN: the fog has no other effect
  EXPECT_TRUE(radar.Step(near).valid);
  EXPECT_FALSE(radar.Step(far).valid);
  far.fog_visibility_m = 20000.0;
  EXPECT_TRUE(radar.Step(far).valid);
}

TEST(RadarTest, AddsTheLossesOfRainAndFog) {
  // Rain of 50 mm/h alone reduces the range to 172.3 m. Fog with 1.57 dB/km reduces this range to
  // 168.5 m.
  Scenario scenario = Exact();
  scenario.fog.model = FogModel::kBeam;
  scenario.fog.rain_mmph = 50.0;
  radar::Radar radar(scenario);
  truth_t truth = Target(170.0);
  EXPECT_TRUE(radar.Step(truth).valid);
  truth.fog_visibility_m = 50.0;
  EXPECT_FALSE(radar.Step(truth).valid);
  truth.host_gap_m = 167.0;
  EXPECT_TRUE(radar.Step(truth).valid);
}

TEST(RadarTest, IsBlindToFogUnderModelBias) {
  Scenario scenario;
  scenario.fog.model = FogModel::kBias;
  radar::Radar radar(scenario);
  truth_t truth = Target(33.0);
  const radar_t clear = radar.Step(truth);
  truth.fog_present = true;
  truth.fog_level = 1.0;
  EXPECT_EQ(radar.Step(truth).range_m, clear.range_m);
}

TEST(RadarTest, ReportsATouchForCarsThatOverlap) {
  radar::Radar radar(Exact());
  const radar_t& out = radar.Step(Target(-1.5, -2.0));
  EXPECT_TRUE(out.valid);
  EXPECT_EQ(out.range_m, 0.0);
  EXPECT_EQ(out.range_rate_mps, -2.0);
}

TEST(RadarTest, NeverReportsANegativeRange) {
  Scenario scenario = Exact();
  scenario.radar.bias_m = -5.0;
  EXPECT_EQ(radar::Radar(scenario).Step(Target(3.0)).range_m, 0.0);
}

TEST(RadarTest, DropsOutAlwaysOrNeverAtTheEndsOfTheProbability) {
  Scenario never = Exact();
  Scenario always = Exact();
  always.radar.dropout_probability = 1.0;
  radar::Radar reliable(never);
  radar::Radar dead(always);
  for (std::int64_t step = 0; step < 1000; ++step) {
    truth_t truth = Target(33.0);
    truth.header.step = step;
    EXPECT_TRUE(reliable.Step(truth).valid);
    EXPECT_FALSE(dead.Step(truth).valid);
  }
}

}  // namespace
}  // namespace fogline
