#include "services/decision/conflict/one_step/divergence.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <boost/math/distributions/chi_squared.hpp>

#include "tests/unit/services/decision/conflict/evidence.h"

namespace fogline {
namespace {

TEST(NisTest, HasTheWorkedValues) {
  EXPECT_NEAR(conflict::NormalisedSquare(Differing(1)), 6.2, 0.05);
  EXPECT_NEAR(conflict::NormalisedSquare(Differing(2)), 24.6, 0.05);
}

TEST(NisTest, LimitsOfChiSquareAreTheQuotedOnes) {
  struct Row {
    double degrees, at_5_pct, at_1_pct, at_tenth_pct, digit;
  };
  constexpr std::array<Row, 5> kTable{{{1, 3.84, 6.63, 10.83, .005},
                                       {2, 5.99, 9.21, 13.82, .005},
                                       {3, 7.81, 11.34, 16.27, .005},
                                       {10, 18.3, 23.2, 29.6, .05},
                                       {20, 31.4, 37.6, 45.3, .05}}};
  for (const Row& row : kTable) {
    const boost::math::chi_squared distribution(row.degrees);
    EXPECT_NEAR(boost::math::quantile(distribution, 0.95), row.at_5_pct, row.digit);
    EXPECT_NEAR(boost::math::quantile(distribution, 0.99), row.at_1_pct, row.digit);
    EXPECT_NEAR(boost::math::quantile(distribution, 0.999), row.at_tenth_pct, row.digit);
  }
}

TEST(NisTest, ExceedsItsFivePercentLimitInFivePercentOfTheSteps) {
  const Random random(1, Stream::kRadar);
  constexpr int kSteps = 20000;
  int exceeded = 0;
  for (int step = 0; step < kSteps; ++step) {
    const double d = UnitNoise(random, step).radar.range_m - UnitNoise(random, step).lidar.range_m;
    if (conflict::NormalisedSquare(Differing(d, 0.6, 0.8)) > 3.841) ++exceeded;
  }
  const double deviation = std::sqrt(0.05 * 0.95 / kSteps);
  EXPECT_NEAR(exceeded / double{kSteps}, 0.05, 4 * deviation);
}

/// The Bhattacharyya distance of two normal distributions: a term for their means, plus a term for
/// their standard deviations. Hellinger() computes the Hellinger distance from this distance.
double Bhattacharyya(const conflict::Disagreement& disagreement) {
  const double product_m2 = disagreement.radar_std_m * disagreement.lidar_std_m;
  return conflict::BhattacharyyaOfMeans(disagreement) +
         std::log(disagreement.variance_m2() / (2 * product_m2)) / 2;
}
double Hellinger(const conflict::Disagreement& disagreement) {
  return std::sqrt(-std::expm1(-Bhattacharyya(disagreement)));
}

TEST(DivergenceTest, HasTheWorkedValuesWithTheOffsetOfUnequalPrecision) {
  EXPECT_NEAR(Hellinger(Differing(0)), .71, 5e-3);
  EXPECT_NEAR(Hellinger(Differing(1)), .945, 5e-4);
  EXPECT_NEAR(Hellinger(Differing(2)), .999, 5e-4);
}

TEST(DivergenceTest, PartOfTheMeansIsAQuarterOfNisWithoutTheOffsetOfUnequalPrecision) {
  EXPECT_EQ(conflict::BhattacharyyaOfMeans(Differing(0)), 0);
  EXPECT_EQ(conflict::HellingerOfMeans(Differing(0)), 0);
  const double offset = Bhattacharyya(Differing(0));
  EXPECT_GT(offset, 0.5);
  for (const double d : {-2.0, 0.3, 1.0}) {
    EXPECT_EQ(conflict::BhattacharyyaOfMeans(Differing(d)),
              conflict::NormalisedSquare(Differing(d)) / 4);
    EXPECT_NEAR(Bhattacharyya(Differing(d)), conflict::BhattacharyyaOfMeans(Differing(d)) + offset,
                1e-12);
  }
}

}  // namespace
}  // namespace fogline
