// Compares the attenuation with figures of the ITU-R recommendations.
#include "services/radar/attenuation.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(AttenuationTest, FogCoefficientAt77GHzMatchesP840) {
  EXPECT_NEAR(radar::FogCoefficient(77.0, 0.0), 3.54, 0.005);
  EXPECT_NEAR(radar::FogCoefficient(77.0, 10.0), 3.15, 0.005);
  EXPECT_NEAR(radar::FogCoefficient(77.0, 20.0), 2.71, 0.005);
}

TEST(AttenuationTest, FogCoefficientGrowsWithTheSquareOfLowFrequencies) {
  // Far below water's relaxation at 20 GHz, Rayleigh absorption is proportional to f^2.
  EXPECT_NEAR(radar::FogCoefficient(2.0, 10.0) / radar::FogCoefficient(1.0, 10.0), 4.0, 0.04);
}

TEST(AttenuationTest, LiquidWaterMeetsBothPairsOfP840) {
  EXPECT_NEAR(radar::LiquidWater_gpm3(300.0), 0.05, 0.0001);
  EXPECT_DOUBLE_EQ(radar::LiquidWater_gpm3(50.0), 0.5);
}

TEST(AttenuationTest, FogTakesTenthsOfADecibelPerKilometre) {
  EXPECT_NEAR(radar::FogCoefficient(77.0, 10.0) * radar::LiquidWater_gpm3(300.0), 0.16, 0.005);
  EXPECT_NEAR(radar::FogCoefficient(77.0, 10.0) * radar::LiquidWater_gpm3(50.0), 1.57, 0.005);
}

TEST(AttenuationTest, RainCoefficientsAt77GHzMatchP838) {
  const radar::RainCoefficients h =
      radar::RainCoefficientsOf(77.0, radar::Polarization::kHorizontal);
  EXPECT_NEAR(h.k, 1.132, 0.0005);
  EXPECT_NEAR(h.alpha, 0.718, 0.0005);
  const radar::RainCoefficients v = radar::RainCoefficientsOf(77.0, radar::Polarization::kVertical);
  EXPECT_NEAR(v.k, 1.128, 0.0005);
  EXPECT_NEAR(v.alpha, 0.707, 0.0005);
}

TEST(AttenuationTest, RainCoefficientsMeetTheTableOfP838) {
  // The expected values are from ITU-R P.838-3, table 5. The table has these frequencies.
  const radar::RainCoefficients h10 =
      radar::RainCoefficientsOf(10.0, radar::Polarization::kHorizontal);
  EXPECT_NEAR(h10.k, 0.01217, 0.00001);
  EXPECT_NEAR(h10.alpha, 1.2571, 0.0001);
  const radar::RainCoefficients v10 =
      radar::RainCoefficientsOf(10.0, radar::Polarization::kVertical);
  EXPECT_NEAR(v10.k, 0.01129, 0.00001);
  EXPECT_NEAR(v10.alpha, 1.2156, 0.0001);
  const radar::RainCoefficients h100 =
      radar::RainCoefficientsOf(100.0, radar::Polarization::kHorizontal);
  EXPECT_NEAR(h100.k, 1.3671, 0.0001);
  EXPECT_NEAR(h100.alpha, 0.6815, 0.0001);
}

TEST(AttenuationTest, RainTakesDecibelsPerKilometre) {
  const radar::RainCoefficients rain =
      radar::RainCoefficientsOf(77.0, radar::Polarization::kHorizontal);
  EXPECT_EQ(radar::RainAttenuation_dbpkm(0.0, rain), 0.0);
  EXPECT_NEAR(radar::RainAttenuation_dbpkm(1.0, rain), 1.1, 0.05);
  EXPECT_NEAR(radar::RainAttenuation_dbpkm(10.0, rain), 5.9, 0.05);
  EXPECT_NEAR(radar::RainAttenuation_dbpkm(25.0, rain), 11.4, 0.05);
  EXPECT_NEAR(radar::RainAttenuation_dbpkm(50.0, rain), 18.8, 0.05);
  EXPECT_NEAR(radar::RainAttenuation_dbpkm(100.0, rain), 30.9, 0.06);
}

TEST(AttenuationTest, MaximumRangeIsWhereTheReceivedPowerIsThatOfTheClearMaximum) {
  constexpr double kClear_m = 250.0;
  for (const double attenuation_dbpkm : {1e-9, 0.16, 1.57, 30.9, 500.0}) {
    const double range_m = radar::MaxRange_m(kClear_m, attenuation_dbpkm);
    const double spreading_db = 40.0 * std::log10(kClear_m / range_m);
    const double loss_db = 2.0 * attenuation_dbpkm * range_m / 1000.0;
    EXPECT_LE(range_m, kClear_m);
    EXPECT_NEAR(spreading_db, loss_db, 1e-9);  // roundings of 40 log10(1 + 1e-16)
  }
}

TEST(AttenuationTest, ThickFogShortensARangeOf100MetresBy1Point8Percent) {
  const double attenuation_dbpkm =
      radar::FogCoefficient(77.0, 10.0) * radar::LiquidWater_gpm3(50.0);
  EXPECT_NEAR(1.0 - radar::MaxRange_m(100.0, attenuation_dbpkm) / 100.0, 0.018, 0.0005);
}

TEST(AttenuationTest, ClearAirLeavesTheMaximumRange) {
  EXPECT_EQ(radar::MaxRange_m(250.0, 0.0), 250.0);
}

}  // namespace
}  // namespace fogline
