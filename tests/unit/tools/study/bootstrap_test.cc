#include "tools/study/bootstrap.h"

#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/tools/study/examples.h"

namespace fogline {
namespace {

constexpr Stream kTest{1'000'000};

TEST(ResamplingTest, DrawsAsManyRunsAsThereAreAndEachAsOftenInTheMean) {
  constexpr std::size_t kRuns = 7;  // odd, so one draw of the last pair is not used
  const study::Resampling resampling(kRuns, kTest);
  std::vector<double> sums(kRuns, 0.0);
  std::vector<double> weights;
  constexpr int kDraws = 2000;
  for (int i = 0; i < kDraws; ++i) {
    resampling.Draw(i, weights);
    EXPECT_EQ(std::accumulate(weights.begin(), weights.end(), 0.0), kRuns);
    for (std::size_t run = 0; run < kRuns; ++run) sums[run] += weights[run];
  }
  // A weight has a variance of 1 - 1/7. The tolerance is five standard deviations of the mean of
  // kDraws weights.
  const double tolerance = 5 * std::sqrt((1 - 1.0 / kRuns) / kDraws);
  for (const double sum : sums) EXPECT_NEAR(sum / kDraws, 1, tolerance);
}

TEST(ResamplingTest, IsTheSameInWhateverOrderItIsDrawn) {
  std::vector<double> first;
  std::vector<double> again;
  study::Resampling(100, kTest).Draw(3, first);
  const study::Resampling other(100, kTest);
  other.Draw(8, again);
  EXPECT_NE(first, again);
  other.Draw(3, again);
  EXPECT_EQ(first, again);
}

TEST(WeightedMeanTest, IsOfTheValuesThatAreThere) {
  EXPECT_EQ(study::WeightedMean(std::array{1.0, kNoNumber, 4.0}, std::array{2.0, 5.0, 1.0}), 2);
  EXPECT_TRUE(std::isnan(study::WeightedMean(std::array{1.0, kNoNumber}, std::array{0.0, 2.0})));
}

TEST(FromReplicatesTest, TakesThePercentiles) {
  std::vector<double> replicates(1001);
  std::iota(replicates.begin(), replicates.end(), 0.0);
  const study::Estimate estimate = study::FromReplicates(30, 480, replicates);
  EXPECT_EQ(estimate.n, 30);
  EXPECT_EQ(estimate.mean, 480);
  EXPECT_NEAR(estimate.low, 25, 1e-9);
  EXPECT_NEAR(estimate.high, 975, 1e-9);
}

TEST(FromReplicatesTest, HasNoIntervalOfOneRunOrWhereAReplicateHasNoValue) {
  EXPECT_FALSE(study::FromReplicates(1, 2, {1, 2, 3}).has_interval());
  // A single replicate without a value is enough: there is no interval, although this replicate is
  // not near the percentiles.
  std::vector<double> replicates(101);
  std::iota(replicates.begin(), replicates.end(), 0.0);
  EXPECT_TRUE(study::FromReplicates(9, 2, replicates).has_interval());
  replicates[40] = kNoNumber;
  EXPECT_FALSE(study::FromReplicates(9, 2, replicates).has_interval());
  EXPECT_EQ(study::VerdictOf(study::FromReplicates(1, 2, {1, 2, 3})), study::Verdict::kTooFew);
}

// An interval must contain the mean of normal values as often as its level says.
TEST(FromReplicatesTest, CoversAMeanInNearlyNineteenOfTwentyExperiments) {
  constexpr std::size_t kRuns = 40;
  constexpr int kExperiments = 200;
  int covered = 0;
  std::vector<double> weights;
  for (int experiment = 0; experiment < kExperiments; ++experiment) {
    const Random random(experiment, kTest);
    std::vector<double> values(kRuns);
    for (std::size_t i = 0; i < kRuns; ++i) {
      values[i] = random.Normal2(0, static_cast<std::uint32_t>(i))[0];
    }
    std::vector<double> replicates;
    const study::Resampling resampling(kRuns, Stream{1'000'001});
    for (int k = 0; k < 200; ++k) {
      resampling.Draw(k, weights);
      replicates.push_back(study::WeightedMean(values, weights));
    }
    const study::Estimate estimate = study::FromReplicates(kRuns, 0, std::move(replicates));
    covered += estimate.low <= 0 && 0 <= estimate.high ? 1 : 0;
  }
  // The intervals of a bootstrap of 40 runs are a little too narrow: they contain the mean with a
  // probability of 0.93, not 0.95. The expected number in 200 experiments is 186, with a deviation
  // of 3.6. The bounds are three deviations away.
  EXPECT_GE(covered, 175);
  EXPECT_LE(covered, 197);
}

}  // namespace
}  // namespace fogline
