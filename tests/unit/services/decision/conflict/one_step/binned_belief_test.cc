#include "services/decision/conflict/one_step/binned_belief.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/services/decision/conflict/evidence.h"

namespace fogline {
namespace {

conflict::BinnedPair Pair(double difference_m,
                          const conflict::ConflictParameters& parameters = {}) {
  return conflict::PairOnBins(Differing(difference_m), parameters);
}

TEST(BinnedBeliefTest, HasTheTabulatedValues) {
  struct Row {
    double d_m, dempster, jousselme, pignistic, correlation, cosine;
  };
  // Bins of 0.5 m, reliability 0.95 of both sensors, standard deviations 0.4 m (radar) and 0.05 m.
  constexpr std::array<Row, 4> kTable{{{0, .547, .138, .20, .03, .03},
                                       {0.5, .680, .390, .48, .39, .39},
                                       {1, .855, .572, .85, .86, .86},
                                       {2, .902, .612, .95, .99, .99}}};
  constexpr double kThreeDigits = 5.1e-4;  // half of the last printed digit
  constexpr double kTwoDigits = 5.1e-3;
  for (const Row& row : kTable) {
    const conflict::BinnedPair pair = Pair(row.d_m);
    EXPECT_NEAR(conflict::DempsterConflict(pair), row.dempster, kThreeDigits) << "d = " << row.d_m;
    EXPECT_NEAR(conflict::JousselmeDistance(pair), row.jousselme, kThreeDigits)
        << "d = " << row.d_m;
    EXPECT_NEAR(conflict::PignisticDistance(pair), row.pignistic, kTwoDigits) << "d = " << row.d_m;
    EXPECT_NEAR(conflict::CorrelationConflict(pair), row.correlation, kTwoDigits)
        << "d = " << row.d_m;
    EXPECT_NEAR(conflict::CosineConflict(pair), row.cosine, kTwoDigits) << "d = " << row.d_m;
  }
}

TEST(BinnedBeliefTest, TheFrameResemblesABinByItsShareOfIt) {
  // GIVEN: four bins. The radar's range is on an edge, so its masses on the bins are (.4, .4, 0,
  // 0). The LiDAR's range is inside of a bin: (0, 0, .8, 0). Each sensor has the mass 0.2 on the
  // frame, which is the set of all bins.
  conflict::ConflictParameters parameters;
  parameters.frame_bins = 4;
  parameters.radar_reliability = 0.8;
  parameters.lidar_reliability = 0.8;
  const conflict::BinnedPair pair = conflict::PairOnBins(Differing(0.75, 0.01, 0.01), parameters);
  // THEN: Jousselme's matrix has D(bin, frame) = 1/4, so the products of the masses are c11 = .32 +
  // .04 + .08 (radar, radar), c22 = .64 + .04 + .08 (LiDAR, LiDAR) and c12 = .04 + .08
  EXPECT_NEAR(conflict::CorrelationConflict(pair), 1 - .12 / std::sqrt(.44 * .76), 1e-12);
  EXPECT_NEAR(conflict::JousselmeDistance(pair), std::sqrt((.44 + .76 - .24) / 2), 1e-12);
  EXPECT_NEAR(conflict::CosineConflict(pair), 1 - .04 / std::sqrt(.36 * .68), 1e-12);
  EXPECT_NEAR(conflict::DempsterConflict(pair), .64, 1e-12);
  EXPECT_NEAR(conflict::PignisticDistance(pair), .8, 1e-12);
}

TEST(BinnedBeliefTest, DempsterFindsConflictInEqualEvidence) {
  // The known defect of Dempster's k: it is above 0 although both sensors give the same value.
  const conflict::BinnedPair pair = conflict::PairOnBins(Differing(0, 0.2, 0.2), {});
  EXPECT_GT(conflict::DempsterConflict(pair), 0.3);
  EXPECT_NEAR(conflict::JousselmeDistance(pair), 0, 1e-7);  // square root of rounding errors
  EXPECT_NEAR(conflict::PignisticDistance(pair), 0, 1e-12);
  EXPECT_NEAR(conflict::CorrelationConflict(pair), 0, 1e-12);
  EXPECT_NEAR(conflict::CosineConflict(pair), 0, 1e-12);
}

TEST(BinnedBeliefTest, ReadingsFarApartHaveOnlyTheFrameInCommon) {
  const conflict::ConflictParameters parameters;
  const conflict::BinnedPair pair = Pair(200);
  EXPECT_EQ(pair.common, 0);
  EXPECT_NEAR(conflict::DempsterConflict(pair), 0.95 * 0.95, 1e-12);
  EXPECT_NEAR(conflict::PignisticDistance(pair), 0.95, 1e-9);
}

TEST(BinnedBeliefTest, MassAddsUpToTheReliabilityHoweverWideTheBelief) {
  // The standard deviations are smaller than a bin, as wide as several bins, and wider than all
  // kept bins (64 bins of 0.5 m).
  for (const double std_m : {0.01, 0.4, 3.0, 40.0}) {
    const conflict::BinnedPair far = conflict::PairOnBins(Differing(2000, std_m, std_m), {});
    EXPECT_NEAR(far.absolute, 2 * 0.95, 1e-9) << std_m;  // the readings share no bin
  }
}

TEST(BinnedBeliefTest, UnequalReliabilityIsADifferenceOfPignisticProbability) {
  conflict::ConflictParameters parameters;
  parameters.lidar_reliability = 0.55;
  // GIVEN: two equal readings, WHEN: the reliability of one reading is lower by 0.4, THEN: 0.4 of
  // its belief is spread over all 500 bins. The readings have belief in about 24 of these bins, so
  // the distance is a little less than 0.4.
  const conflict::BinnedPair pair = conflict::PairOnBins(Differing(0, 0.2, 0.2), parameters);
  EXPECT_NEAR(conflict::PignisticDistance(pair), 0.4, 0.02);
  EXPECT_GT(conflict::JousselmeDistance(pair), 0.2);
}

TEST(BinnedBeliefTest, IsNotMonotoneBetweenMultiplesOfTheWidth) {
  // This is a limit of bins, not of the measures: a reading in the middle of a bin is more certain
  // than a reading on an edge.
  EXPECT_GT(conflict::JousselmeDistance(Pair(0.25)), conflict::JousselmeDistance(Pair(0.5)) + 0.05);
}

}  // namespace
}  // namespace fogline
