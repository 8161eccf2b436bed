// The beam in fog, compared with independent numbers: crossover ranges of two published parameter
// sets, brute-force integration, and the limit of short pulses.
#include "services/lidar/fog_beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "services/visibility.h"
#include "tests/unit/services/lidar/crossover_range.h"

namespace fogline {
namespace {

constexpr double kSpeedOfLight_mps = 299'792'458.0;
constexpr double kBackscatterFactor = 0.046;  // beta times visibility, Hahner et al. 2021

// Defaults of Hahner et al. 2021. Their reflectivity Gamma of 1e-6 contains a factor 2/c (c: speed
// of light). Without this factor Gamma is 150.
constexpr lidar::BeamOptics kHahner{
    .pulse_length_m = kSpeedOfLight_mps * 20e-9, .overlap_start_m = 0.9, .overlap_end_m = 1.0};
constexpr double kHahnerReflectivity = 1e-6 * kSpeedOfLight_mps / 2.0;

// A current sensor: 5 ns pulse, overlap from 2 to 5 m.
constexpr lidar::BeamOptics kPhysical{
    .pulse_length_m = kSpeedOfLight_mps * 5e-9, .overlap_start_m = 2.0, .overlap_end_m = 5.0};

const std::vector<double> kVisibilities_m{600, 300, 150, 100, 75, 50, 40, 30, 20};

double Crossover(const lidar::BeamOptics& optics, double reflectivity, double visibility_m) {
  const double extinction_pm = ExtinctionOf(visibility_m);
  return test::CrossoverRange_m(lidar::FindFogPeak(optics, extinction_pm).strength_pm, reflectivity,
                                kBackscatterFactor / visibility_m, extinction_pm);
}

// The expected ranges in the tests below are whole metres. The tolerance is half a metre for this
// rounding, plus a little, because these ranges come from a numerical integration.
constexpr double kTableTolerance_m = 0.6;

struct Row {
  const char* what;
  lidar::BeamOptics optics;
  double reflectivity;
  std::vector<double> crossovers_m;  // in the order of kVisibilities_m
};

TEST(FogBeamTest, FogOutshinesTheTargetBeyondTheTabulatedRanges) {
  const std::vector<Row> rows{
      {"Hahner", kHahner, kHahnerReflectivity, {260, 151, 87, 62, 49, 36, 30, 24, 17}},
      {"usual car", kPhysical, 0.5, {135, 83, 51, 38, 31, 23, 20, 16, 12}},
      {"retroreflector", kPhysical, 5.0, {245, 144, 84, 61, 49, 35, 30, 24, 18}},
      {"dark car", kPhysical, 0.1, {79, 51, 33, 25, 21, 16, 14, 12, 9}}};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < kVisibilities_m.size(); ++i) {
      EXPECT_NEAR(Crossover(row.optics, row.reflectivity, kVisibilities_m[i]), row.crossovers_m[i],
                  kTableTolerance_m)
          << row.what << ", visibility " << kVisibilities_m[i];
    }
  }
}

TEST(FogBeamTest, AttenuationAloneLeavesTheTabulatedRanges) {
  const std::vector<double> of_120_m{80, 64, 47, 38, 33, 26, 22, 19, 14};
  const std::vector<double> of_200_m{113, 85, 60, 48, 40, 31, 27, 22, 17};
  for (std::size_t i = 0; i < kVisibilities_m.size(); ++i) {
    const double extinction_pm = ExtinctionOf(kVisibilities_m[i]);
    EXPECT_NEAR(test::AttenuatedRange_m(120.0, extinction_pm), of_120_m[i], kTableTolerance_m);
    EXPECT_NEAR(test::AttenuatedRange_m(200.0, extinction_pm), of_200_m[i], kTableTolerance_m);
  }
  EXPECT_EQ(test::AttenuatedRange_m(120.0, 0.0), 120.0);
}

TEST(FogBeamTest, TheFogsPeakLiesInTheNearFieldAndComesNearerInDenserFog) {
  EXPECT_NEAR(lidar::FindFogPeak(kHahner, 0.005).range_m, 1.7, 0.05);
  EXPECT_NEAR(lidar::FindFogPeak(kHahner, 0.15).range_m, 1.55, 0.05);
  EXPECT_NEAR(lidar::FindFogPeak(kPhysical, 0.005).range_m, 4.0, 0.05);
  EXPECT_NEAR(lidar::FindFogPeak(kPhysical, 0.15).range_m, 3.1, 0.05);
}

TEST(FogBeamTest, CrossoverIsWhereTheRatioOfTheEchoesIsOne) {
  for (const double visibility_m : kVisibilities_m) {
    const double extinction_pm = ExtinctionOf(visibility_m);
    const double backscatter_pmsr = kBackscatterFactor / visibility_m;
    const double strength_pm = lidar::FindFogPeak(kPhysical, extinction_pm).strength_pm;
    const double range_m =
        test::CrossoverRange_m(strength_pm, 0.5, backscatter_pmsr, extinction_pm);
    const double ratio = std::numbers::pi * backscatter_pmsr / 0.5 * strength_pm * range_m *
                         range_m * std::exp(2.0 * extinction_pm * range_m);
    EXPECT_NEAR(ratio, 1.0, 1e-12);
  }
}

// The strongest echo of the fog in a grid of ranges. For each range, the pulse is centred at this
// range. The echo is the integral of the pulse times the channel gain, by the trapezoidal rule.
lidar::FogPeak BruteForce(const lidar::BeamOptics& optics, double extinction_pm,
                          double centre_step_m) {
  constexpr int kPoints = 4000;
  lidar::FogPeak best{0.0, 0.0};
  const double until_m = optics.overlap_end_m + 0.5 * optics.pulse_length_m;
  for (double centre_m = optics.overlap_start_m; centre_m < until_m; centre_m += centre_step_m) {
    double sum = 0.0;
    for (int k = 1; k < kPoints; ++k) {
      const double r = centre_m + optics.pulse_length_m * (0.5 - static_cast<double>(k) / kPoints);
      if (r <= optics.overlap_start_m) break;
      const double wave = std::sin(std::numbers::pi * k / kPoints);
      sum += wave * wave * lidar::ChannelGain(optics, extinction_pm, r);
    }
    sum *= optics.pulse_length_m / kPoints;
    if (sum > best.strength_pm) best = {sum, centre_m};
  }
  return best;
}

TEST(FogBeamTest, PeakMatchesBruteForceOverTheRangeOfParameters) {
  const std::vector<lidar::BeamOptics> all{
      kHahner,
      kPhysical,
      {.pulse_length_m = 0.15, .overlap_start_m = 2.0, .overlap_end_m = 3.0},
      {.pulse_length_m = 24.0, .overlap_start_m = 0.1, .overlap_end_m = 0.2},
      {.pulse_length_m = 3.0, .overlap_start_m = 20.0, .overlap_end_m = 40.0},
      {.pulse_length_m = 1.5, .overlap_start_m = 2.0, .overlap_end_m = 2.0}};
  for (const lidar::BeamOptics& optics : all) {
    for (const double extinction_pm : {0.0, 1.5e-4, 0.03, 0.6}) {
      const double step_m =
          (optics.overlap_end_m - optics.overlap_start_m + 0.5 * optics.pulse_length_m) / 200.0;
      const lidar::FogPeak expected = BruteForce(optics, extinction_pm, step_m);
      const lidar::FogPeak peak = lidar::FindFogPeak(optics, extinction_pm);
      // The overlap of beam and field of view has kinks. Near a kink, a search on a grid errs by up
      // to 0.3 % in the peak's strength, and by two grid steps in its range.
      EXPECT_NEAR(peak.strength_pm / expected.strength_pm, 1.0, 3e-3)
          << optics.pulse_length_m << " " << extinction_pm;
      EXPECT_NEAR(peak.range_m, expected.range_m, 2.0 * step_m)
          << optics.pulse_length_m << " " << extinction_pm;
    }
  }
}

TEST(FogBeamTest, AShortPulseSeesTheGainItself) {
  const lidar::BeamOptics optics{
      .pulse_length_m = 0.01, .overlap_start_m = 2.0, .overlap_end_m = 6.0};
  const lidar::FogPeak peak = lidar::FindFogPeak(optics, 0.0);
  EXPECT_NEAR(peak.range_m, 4.0, 0.01) << "(r - 2) / r^2 is largest at 4";
  EXPECT_NEAR(peak.strength_pm, 0.005 * lidar::ChannelGain(optics, 0.0, 4.0), 1e-6);
}

TEST(FogBeamTest, OverlapRisesLinearlyFromStartToEnd) {
  EXPECT_EQ(lidar::Overlap(kPhysical, 1.0), 0.0);
  EXPECT_EQ(lidar::Overlap(kPhysical, 2.0), 0.0);
  EXPECT_DOUBLE_EQ(lidar::Overlap(kPhysical, 3.5), 0.5);
  EXPECT_EQ(lidar::Overlap(kPhysical, 5.0), 1.0);
  EXPECT_EQ(lidar::Overlap(kPhysical, 50.0), 1.0);
}

TEST(FogBeamTest, AnOverlapThatEndsBeforeItStartsIsAStep) {
  LidarBeamSection beam;
  beam.overlap_start_m = 3.0;
  beam.overlap_end_m = 1.0;
  const lidar::BeamOptics optics = lidar::OpticsOf(beam);
  EXPECT_EQ(lidar::Overlap(optics, 3.0), 0.0);
  EXPECT_EQ(lidar::Overlap(optics, 3.001), 1.0);
}

TEST(FogBeamTest, PulseLengthIsLightTimesItsDuration) {
  LidarBeamSection beam;
  beam.pulse_half_width_ns = 20.0;
  EXPECT_DOUBLE_EQ(lidar::OpticsOf(beam).pulse_length_m, kHahner.pulse_length_m);
}

TEST(FogBeamTest, ScatterIsBetweenZeroAndOneAndGrowsAsItsNumbersShrink) {
  EXPECT_GT(lidar::Beta2And20(1.0 - 1e-15, 1.0 - 1e-15), 0.0);
  EXPECT_LT(lidar::Beta2And20(1e-16, 1e-16), 1.0);
  EXPECT_GT(lidar::Beta2And20(0.4, 0.5), lidar::Beta2And20(0.5, 0.5));
  EXPECT_GT(lidar::Beta2And20(0.5, 0.4), lidar::Beta2And20(0.5, 0.5));
}

}  // namespace
}  // namespace fogline
