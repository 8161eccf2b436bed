#include "services/decision/conflict/one_step/consonant_belief.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "tests/unit/services/decision/conflict/evidence.h"

namespace fogline {
namespace {

constexpr int kLevels = 20;

double NormalBelow(double u) { return std::erfc(-u / std::numbers::sqrt2) / 2; }

TEST(ConsonantConflictTest, HasTheTabulatedValues) {
  constexpr std::array<std::pair<double, double>, 6> kTable{
      {{0, 0}, {0.2, .0085}, {0.5, .225}, {1, .847}, {1.5, .994}, {2, 1}}};
  for (const auto& [d_m, k] : kTable) {
    EXPECT_NEAR(conflict::ConsonantConflict(Differing(d_m)), k, d_m == 0.2 ? 5.1e-5 : 5.1e-4)
        << d_m;
  }
}

TEST(ConsonantConflictTest, AgreesWithAPlainSumOverBothIntervals) {
  // The conflict is the probability P(s1 Y1 + s2 Y2 < d). Y1 and Y2 have Maxwell's distribution,
  // and the sum goes over small cells of Y1.
  constexpr int kParts = 4000;
  constexpr double kReach = 8;
  for (const auto& [s1, s2] : {std::pair{0.4, 0.05}, std::pair{0.3, 0.3}, std::pair{0.02, 2.0}}) {
    for (const double d : {0.3, 1.0, 2.5}) {
      double sum = 0;
      for (int i = 0; i < kParts; ++i) {
        const double low = kReach * i / kParts;
        const double high = kReach * (i + 1) / kParts;
        sum += (conflict::MaxwellBelow(high) - conflict::MaxwellBelow(low)) *
               conflict::MaxwellBelow((d - s1 * (low + high) / 2) / s2);
      }
      EXPECT_NEAR(conflict::ConsonantConflict(Differing(d, s1, s2)), sum, 1e-6) << s1 << ' ' << s2;
    }
  }
}

TEST(ConsonantConflictTest, HasNoUnitOfItsOwn) {
  for (const double scale : {0.01, 3.0, 100.0}) {
    EXPECT_NEAR(conflict::ConsonantConflict(Differing(0.7 * scale, 0.4 * scale, 0.05 * scale)),
                conflict::ConsonantConflict(Differing(0.7)), 1e-12);
  }
}

TEST(ConsonantConflictTest, IsTheSameWhicheverSensorIsThePreciseOne) {
  EXPECT_EQ(conflict::ConsonantConflict(Differing(0.7, 0.4, 0.05)),
            conflict::ConsonantConflict(Differing(-0.7, 0.05, 0.4)));
}

TEST(ConsonantPignisticTest, IsTheTotalVariationOfTheGaussians) {
  // The distance is half of the integral of |p1 - p2|, with the densities p1 and p2 of the two
  // readings. The test adds up the differences of their probabilities in small cells.
  constexpr double kCell_m = 1e-3;
  for (const auto& [s1, s2] : {std::pair{0.4, 0.05}, std::pair{0.3, 0.3}, std::pair{0.1, 1.0}}) {
    for (const double d : {0.0, 0.2, 1.0, 3.0}) {
      double sum = 0;
      for (double x = -8; x < 12; x += kCell_m) {
        sum += std::abs(NormalBelow((x + kCell_m) / s1) - NormalBelow(x / s1) -
                        NormalBelow((x + kCell_m - d) / s2) + NormalBelow((x - d) / s2));
      }
      EXPECT_NEAR(conflict::ConsonantPignisticDistance(Differing(d, s1, s2)), sum / 2, 1e-5)
          << s1 << ' ' << s2 << ' ' << d;
    }
  }
}

TEST(ConsonantPignisticTest, IsContinuousWhereThePrecisionsAreEqual) {
  for (const double d : {0.0, 1e-9, 0.1, 1.0, 30.0}) {
    const double equal = conflict::ConsonantPignisticDistance(Differing(d, 0.3, 0.3));
    EXPECT_NEAR(equal, std::erf(d / (2 * std::numbers::sqrt2 * 0.3)), 1e-12);
    for (const double s2 : {std::nextafter(0.3, 1.0), 0.3 * (1 - 1e-12), 0.3 * (1 + 1e-9)}) {
      EXPECT_NEAR(conflict::ConsonantPignisticDistance(Differing(d, 0.3, s2)), equal, 1e-8) << d;
    }
  }
}

TEST(ConsonantBeliefsTest, LevelsStandForTheDensity) {
  // The test integrates the product of both readings' plausibilities pl(x) = 1 - F(|x - mu|/s). F
  // is Maxwell's distribution, mu the reading, and s its standard deviation.
  const auto plausibility = [](double y) { return 1 - conflict::MaxwellBelow(y); };
  const conflict::ConsonantBeliefs beliefs(kLevels);
  for (const double d : {0.0, 0.5, 1.0}) {
    double integral = 0;
    constexpr double kCell_m = 1e-3;
    for (double x = -4; x < 5; x += kCell_m) {
      integral += kCell_m * plausibility(std::abs(x) / kRadarStd_m) *
                  plausibility(std::abs(x - d) / kLidarStd_m);
    }
    EXPECT_NEAR(beliefs.ContourProduct(d, kRadarStd_m, kLidarStd_m), integral, 0.02 * integral);
  }
}

TEST(ConsonantBeliefsTest, AgreeWithTwiceAsManyLevels) {
  const conflict::ConsonantBeliefs few(kLevels);
  const conflict::ConsonantBeliefs many(2 * kLevels);
  for (const double d : {0.0, 0.3, 0.6, 1.0, 1.5, 3.0}) {
    EXPECT_NEAR(few.CorrelationConflict(Differing(d)), many.CorrelationConflict(Differing(d)), .03);
    EXPECT_NEAR(few.JousselmeDistance(Differing(d)), many.JousselmeDistance(Differing(d)), .03);
    EXPECT_NEAR(few.CosineConflict(Differing(d)), many.CosineConflict(Differing(d)), .03);
  }
}

TEST(ConsonantBeliefsTest, FindNoConflictInEqualEvidenceUnlikeDempsterOnBins) {
  const conflict::ConsonantBeliefs beliefs(kLevels);
  const conflict::Disagreement none = Differing(0, 0.3, 0.3);
  EXPECT_EQ(conflict::ConsonantConflict(none), 0);
  EXPECT_EQ(conflict::ConsonantPignisticDistance(none), 0);
  EXPECT_NEAR(beliefs.JousselmeDistance(none), 0, 1e-7);  // square root of rounding errors
  EXPECT_NEAR(beliefs.CorrelationConflict(none), 0, 1e-12);
  EXPECT_NEAR(beliefs.CosineConflict(none), 0, 1e-12);
}

TEST(ConsonantBeliefsTest, ReadingsFarApartHaveNothingInCommon) {
  const conflict::ConsonantBeliefs beliefs(kLevels);
  EXPECT_EQ(beliefs.CorrelationConflict(Differing(50)), 1);
  EXPECT_EQ(beliefs.CosineConflict(Differing(50)), 1);
  EXPECT_EQ(beliefs.JousselmeDistance(Differing(50)), std::sqrt(beliefs.JaccardSquare()));
}

}  // namespace
}  // namespace fogline
