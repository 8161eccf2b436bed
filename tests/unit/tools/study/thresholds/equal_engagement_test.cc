#include "tools/study/thresholds/equal_engagement.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "common/random.h"

namespace fogline {
namespace {

// Points in the order of the threshold. RHE falls, then stays at 0 while the gain still rises.
constexpr std::array<study::CurvePoint, 5> kCurve{
    {{.rhe_pct = 100, .gain = -50}, {40, 10}, {20, 20}, {0, 22}, {0, 30}}};

TEST(BestAtTest, InterpolatesBetweenNeighbours) {
  const auto place = study::BestAt(kCurve, 25);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->below, 1U);
  EXPECT_EQ(place->share, 0.75);
  EXPECT_EQ(place->gain, 17.5);
}

TEST(BestAtTest, TakesTheBestWhereSeveralHaveThisEngagement) {
  const auto place = study::BestAt(kCurve, 0);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->below, 4U);
  EXPECT_EQ(place->gain, 30);
  // Two points have RHE 0. An RHE just above 0 lies on the line to the worse one of them.
  EXPECT_NEAR(study::BestAt(kCurve, 1e-9)->gain, 22, 1e-6);
}

TEST(BestAtTest, HasNoPlaceBeyondTheCurve) {
  EXPECT_FALSE(study::BestAt(kCurve, 100.5));
  EXPECT_FALSE(study::BestAt(kCurve, -0.5));
  EXPECT_FALSE(study::BestAt(kCurve, std::numeric_limits<double>::quiet_NaN()));
}

TEST(InterpolationErrorTest, IsThatOfTheNeighboursAtThePlace) {
  // The error of a point is the difference between its gain and the gain on the line between its
  // two neighbours.
  // RHE 40 % lies between 100 % and 20 %. Three quarters of the way from -50 to 20, the gain is
  // 2.5. The gain of the point is 10, so its error is 7.5. The stretch from 40 % to 20 % is shorter
  // than the stretch from 100 % to 40 %, so the error is not increased.
  // RHE 20 % lies between 40 % and 0 %. Halfway from 10 to 22, the gain is 16. The gain of the
  // point is 20, so its error is 4.
  EXPECT_NEAR(study::InterpolationErrorAt(kCurve, *study::BestAt(kCurve, 30)), 7.5, 1e-12);
  EXPECT_NEAR(study::InterpolationErrorAt(kCurve, *study::BestAt(kCurve, 10)), 4, 1e-12);
  EXPECT_NEAR(study::InterpolationErrorAt(kCurve, *study::BestAt(kCurve, 5)), 3, 1e-12);
  EXPECT_EQ(study::InterpolationErrorAt(kCurve, *study::BestAt(kCurve, 20)), 0)
      << "a threshold that was run";
}

// The gain is the square of the RHE, and the stretch in the middle is ten times as long as the
// others.
TEST(InterpolationErrorTest, CoversALongStretchBetweenShortOnes) {
  std::vector<study::CurvePoint> curve;
  for (const double rhe : {0.0, 1.0, 11.0, 12.0})
    curve.push_back({.rhe_pct = rhe, .gain = rhe * rhe});
  const study::CurvePlace place = *study::BestAt(curve, 6);
  EXPECT_GE(study::InterpolationErrorAt(curve, place), std::abs(place.gain - 36));
}

TEST(InterpolationErrorTest, LeavesADifferenceUndecidedThatIsNoLarger) {
  study::AtEqualEngagement one{
      .difference = {.n = 9, .mean = 2, .deviation = 1, .low = 1, .high = 3}};
  one.interpolation_error = 0.9;
  EXPECT_EQ(one.verdict(), study::Verdict::kMore);
  one.interpolation_error = 1.1;
  EXPECT_EQ(one.verdict(), study::Verdict::kUndecided);
}

/// The RHE and the gain of a rule in many situations. Each situation has a random difficulty, which
/// is the same for all rules. The gain is 30 times this difficulty, minus the mean RHE, plus
/// `more`.
struct Rule {
  std::vector<double> rhe_pct;
  std::vector<double> gain;
};
Rule MakeRule(double mean_rhe_pct, double more) {
  constexpr std::uint32_t kSituations = 200;
  const Random random(1, Stream{1'000'002});
  Rule rule;
  for (std::uint32_t i = 0; i < kSituations; ++i) {
    const auto [difficulty, noise] = random.Normal2(0, i);
    rule.rhe_pct.push_back(mean_rhe_pct + noise);
    rule.gain.push_back(30 * difficulty - mean_rhe_pct + more);
  }
  return rule;
}
study::RuleValues ValuesOf(const Rule& rule) {
  return {.rhe_pct = rule.rhe_pct, .gain = rule.gain};
}

TEST(AgainstFixedTest, FindsASmallDifferenceUnderTheLargeOneOfTheSituations) {
  const std::vector fixed{MakeRule(80, 0), MakeRule(40, 0), MakeRule(10, 0)};
  const std::vector values{ValuesOf(fixed[0]), ValuesOf(fixed[1]), ValuesOf(fixed[2])};
  const Rule better = MakeRule(25, 0.5);
  const Rule worse = MakeRule(25, -0.5);
  const Rule beyond = MakeRule(5, 9);
  const std::vector rules{ValuesOf(better), ValuesOf(worse), ValuesOf(beyond)};
  const std::vector<study::AtEqualEngagement> all = study::AgainstFixed(values, rules);
  // The gains have a deviation of 30 points over the situations. Without pairs, 200 situations
  // could not show a difference of 0.5.
  EXPECT_NEAR(all[0].difference.mean, 0.5, 1e-9);
  EXPECT_EQ(study::VerdictOf(all[0].difference), study::Verdict::kMore);
  EXPECT_EQ(all[0].place->below, 1U);
  EXPECT_EQ(study::VerdictOf(all[1].difference), study::Verdict::kLess);
  EXPECT_FALSE(all[2].place) << "it engages less than any threshold";
  EXPECT_FALSE(all[2].difference.has_interval());
}

TEST(AgainstFixedTest, KnowsThatTheEngagementIsAnEstimateToo) {
  // The rule's own RHE has a deviation of 20 points over 200 situations, so its mean has a
  // deviation of 1.4 points. On the line of the fixed rules, one point more RHE is one point less
  // gain. So the uncertainty of the RHE alone is 1.4 points of gain.
  Rule low = MakeRule(80, 0);
  Rule high = MakeRule(10, 0);
  Rule rule = MakeRule(40, 0);
  const Random random(2, Stream{1'000'002});
  for (std::size_t i = 0; i < rule.rhe_pct.size(); ++i) {
    rule.rhe_pct[i] = 40 + 20 * random.Normal2(0, static_cast<std::uint32_t>(i))[0];
  }
  const std::vector fixed{ValuesOf(low), ValuesOf(high)};
  const std::vector rules{ValuesOf(rule)};
  const study::Estimate difference = study::AgainstFixed(fixed, rules).front().difference;
  const double width = difference.high - difference.low;
  EXPECT_NEAR(width, 2 * 1.96 * 20 / std::sqrt(200), 0.8);
}

}  // namespace
}  // namespace fogline
