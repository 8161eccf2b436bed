#include "services/metrics/surrogate.h"

#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "tests/unit/services/metrics/example_runs.h"

namespace fogline {
namespace {

// A gap of 30 m to a car at 20 m/s. The car behind drives 5 m/s faster.
constexpr metrics::CarPair kClosing{.gap_m = 30, .speed_mps = 25, .lead_speed_mps = 20};
constexpr metrics::CarPair kFollowing{.gap_m = 30, .speed_mps = 20, .lead_speed_mps = 20};

metrics::PairMetrics Collect(std::initializer_list<metrics::CarPair> pairs,
                             const MeasuresSection& section = {}) {
  metrics::PairAccumulator accumulator(section);
  double since_s = 0;
  for (const metrics::CarPair& pair : pairs) {
    accumulator.Add(pair, since_s);
    since_s = kStep_s;
  }
  return accumulator.Result();
}

// A pair that collides after `ttc_s`: the car behind is 10 m/s faster.
metrics::CarPair CollidingWithin(double ttc_s) { return {10 * ttc_s, 30, 20}; }

TEST(SurrogateTest, TimeToCollisionIsGapOverClosingSpeed) {
  EXPECT_EQ(metrics::TimeToCollision(kClosing), 6);
  EXPECT_TRUE(std::isinf(metrics::TimeToCollision(kFollowing)));
  EXPECT_TRUE(std::isinf(metrics::TimeToCollision({30, 15, 20})));
  EXPECT_EQ(metrics::TimeToCollision({-0.1, 25, 20}), 0);
}

TEST(SurrogateTest, DecelerationToAvoidACrashStopsTheClosingWithinTheGap) {
  EXPECT_DOUBLE_EQ(metrics::DecelerationToAvoidCrash(kClosing), 25.0 / 60);
  EXPECT_EQ(metrics::DecelerationToAvoidCrash(kFollowing), 0);
  EXPECT_EQ(metrics::DecelerationToAvoidCrash({30, 15, 20}), 0);
  EXPECT_TRUE(std::isinf(metrics::DecelerationToAvoidCrash({0, 25, 20})));
}

TEST(SurrogateTest, UrgentDecelerationGapIsWhatBothBrakingsLeave) {
  // Both cars brake with 3.3 m/s2. The car ahead needs 20^2/6.6 = 60.61 m to stop. The car behind
  // needs 25 m during its reaction of 1 s, and then 25^2/6.6 = 94.70 m.
  EXPECT_NEAR(metrics::UrgentDecelerationGap({}, kClosing), 30 + 60.6061 - 94.6970 - 25, 1e-4);
  EXPECT_EQ(metrics::UrgentDecelerationGap({}, kFollowing), 10);
}

TEST(SurrogateTest, CrashProbabilityIsThatOfATruncatedNormalDistribution) {
  MeasuresSection section;
  section.madr_mean_mps2 = 8;
  section.madr_std_mps2 = 1;
  section.madr_least_mps2 = 7;
  section.madr_most_mps2 = 9;
  EXPECT_EQ(metrics::CrashProbability(section, 7), 0);
  EXPECT_NEAR(metrics::CrashProbability(section, 8), 0.5, 1e-12);
  // The expected value is (0.691462 - 0.158655)/0.682689, from tables of the normal distribution:
  // the probabilities of values below 0.5, below -1, and between -1 and 1 standard deviations.
  EXPECT_NEAR(metrics::CrashProbability(section, 8.5), 0.780453, 2e-6);
  EXPECT_EQ(metrics::CrashProbability(section, 9), 1);
  EXPECT_EQ(metrics::CrashProbability(section, std::numeric_limits<double>::infinity()), 1);
}

TEST(SurrogateTest, CrashProbabilityHoldsWhereTheLimitsLeaveNothingOfTheDistribution) {
  MeasuresSection section;
  section.madr_mean_mps2 = 0.1;
  section.madr_std_mps2 = 0.01;
  section.madr_least_mps2 = 5;
  EXPECT_EQ(metrics::CrashProbability(section, 4), 0);
  EXPECT_EQ(metrics::CrashProbability(section, 6), 1);
}

TEST(PairAccumulatorTest, KeepsTheWorstOfEachMeasure) {
  const metrics::PairMetrics m = Collect({kFollowing, kClosing, {40, 20, 20}});
  EXPECT_EQ(m.min_ttc_s, 6);
  EXPECT_EQ(m.min_time_gap_s, 30.0 / 25);
  EXPECT_DOUBLE_EQ(*m.max_drac_mps2, 25.0 / 60);
  EXPECT_EQ(m.min_picud_m, metrics::UrgentDecelerationGap({}, kClosing));
}

TEST(PairAccumulatorTest, RssMarginIsTheGapBeyondTheSafeDistance) {
  // The safe distance by RssSafeDistance() is 20 * 0.5 + 2 * 0.25/2 + 21^2/12 - 20^2/16 = 10 + 0.25
  // + 36.75 - 25 = 22 m.
  EXPECT_NEAR(*Collect({kFollowing}).min_rss_margin_m, 8, 1e-12);
}

TEST(PairAccumulatorTest, RssMarginWithTheParametersOfAdRssLibDoesNotDependOnTheScenario) {
  // The safe distance with these parameters is 20 * 1 + 3.5 * 1/2 + 23.5^2/8 - 20^2/16 = 20 + 1.75
  // + 69.03125 - 25 = 65.78125 m.
  EXPECT_NEAR(*Collect({kFollowing}).min_rss_margin_ad_rss_m, 30 - 65.78125, 1e-12);
  MeasuresSection section;
  section.rss_response_s = 0;
  const metrics::PairMetrics m = Collect({kFollowing, {40, 20, 20}}, section);
  EXPECT_NEAR(*m.min_rss_margin_ad_rss_m, 30 - 65.78125, 1e-12);
  EXPECT_GT(*m.min_rss_margin_m, 8);
}

TEST(PairAccumulatorTest, IntegratesTheTimeBelowTheCriticalTimeToCollision) {
  // The critical time to collision is 2 s. The last step has no duration.
  const metrics::PairMetrics m =
      Collect({CollidingWithin(3), CollidingWithin(2), CollidingWithin(1), CollidingWithin(1.5),
               kFollowing, CollidingWithin(1)});
  EXPECT_EQ(m.tet_s, 3 * kStep_s);
  EXPECT_EQ(m.tit_s2, (0 + 1 + 0.5) * kStep_s);
}

TEST(PairAccumulatorTest, CrashPotentialIsTheMeanProbabilityOverTime) {
  MeasuresSection section;
  section.madr_mean_mps2 = 8;
  section.madr_std_mps2 = 1;
  section.madr_least_mps2 = 7;
  section.madr_most_mps2 = 9;
  // The probability of a crash is 1/2 if the required deceleration is 10^2/(2 * 6.25) = 8 m/s2. One
  // of the four steps with a duration requires this deceleration.
  const metrics::CarPair hard{.gap_m = 6.25, .speed_mps = 30, .lead_speed_mps = 20};
  EXPECT_NEAR(*Collect({kFollowing, hard, kFollowing, kFollowing, hard}, section).cpi, 0.125,
              1e-12);
}

TEST(PairAccumulatorTest, ContactIsNoTimeAndNoFiniteDeceleration) {
  const metrics::PairMetrics m = Collect({kClosing, {-0.1, 25, 20}, {-0.1, 25, 20}});
  EXPECT_EQ(m.min_ttc_s, 0);
  EXPECT_EQ(m.min_time_gap_s, 0);
  EXPECT_DOUBLE_EQ(*m.max_drac_mps2, 25.0 / 60);
  EXPECT_EQ(m.tet_s, kStep_s);
  EXPECT_EQ(m.cpi, 0.5);
}

TEST(PairAccumulatorTest, HasNoValuesWithoutACarAhead) {
  const metrics::PairMetrics m = Collect({{kNone, 20, 20}, {30, kNone, 20}});
  EXPECT_EQ(m.min_ttc_s, std::nullopt);
  EXPECT_EQ(m.tet_s, std::nullopt);
  EXPECT_EQ(m.max_drac_mps2, std::nullopt);
  EXPECT_EQ(m.min_rss_margin_m, std::nullopt);
  EXPECT_EQ(m.min_rss_margin_ad_rss_m, std::nullopt);
  EXPECT_EQ(m.cpi, std::nullopt);
}

TEST(PairAccumulatorTest, ACarThatStandsHasNoTimeGap) {
  EXPECT_EQ(Collect({{5, 0, 0}}).min_time_gap_s, std::nullopt);
}

}  // namespace
}  // namespace fogline
