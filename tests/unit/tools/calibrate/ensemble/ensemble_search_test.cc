#include "tools/calibrate/ensemble/ensemble_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace fogline {
namespace {

using Shares = std::vector<double>;

Shares AsTheyAre(const Shares& shares) { return shares; }

/// A landscape of two fields. Every point meets the target, for the seeds of the search and for the
/// fresh seeds.
calibrate::Landscape Plain() {
  return {.fields = 2,
          .searched = [](const Shares&) { return 0.0; },
          .fresh = [](const Shares&) { return 0.0; },
          .rounded = AsTheyAre};
}

/// A landscape in which a point meets the target if its first field lies at a share of 0.45 to 0.55
/// of the field's range.
calibrate::Landscape Valley() {
  calibrate::Landscape landscape = Plain();
  landscape.searched = [](const Shares& shares) {
    const double off = (shares[0] - 0.5) / 0.05;
    return off * off;
  };
  return landscape;
}

calibrate::PointEnsemble Find(const calibrate::Landscape& landscape,
                              const calibrate::EnsembleRules& rules) {
  return calibrate::FindPoints(landscape, rules, [](int, const calibrate::EnsembleCounts&) {});
}

TEST(ShareDistanceTest, IsTheRootMeanSquareOfTheDifferences) {
  EXPECT_EQ(calibrate::ShareDistance(Shares{0.2, 0.7}, Shares{0.2, 0.7}), 0);
  EXPECT_EQ(calibrate::ShareDistance(Shares{0, 0, 0}, Shares{1, 1, 1}), 1);
  EXPECT_DOUBLE_EQ(calibrate::ShareDistance(Shares{0, 0.5}, Shares{0.6, 0.5}), std::sqrt(0.18));
}

TEST(LatinHypercubeTest, HasOnePointInEachPartOfEachField) {
  constexpr int kPoints = 16;
  const auto points = calibrate::LatinHypercube(kPoints, 3, 1);
  ASSERT_EQ(points.size(), 16U);
  for (std::size_t field = 0; field < 3; ++field) {
    std::set<int> parts;
    for (const Shares& point : points) parts.insert(static_cast<int>(point[field] * kPoints));
    EXPECT_EQ(parts.size(), 16U) << field;
    EXPECT_EQ(*parts.begin(), 0) << field;
    EXPECT_EQ(*parts.rbegin(), kPoints - 1) << field;
  }
  EXPECT_EQ(calibrate::LatinHypercube(kPoints, 3, 1), points);
  EXPECT_NE(calibrate::LatinHypercube(kPoints, 3, 2), points);
}

TEST(FindPointsTest, KeepsOnlyPointsThatAreFarEnoughFromEachOther) {
  // GIVEN a landscape in which every start meets the target, but not all starts are far enough
  // apart
  const auto found = Find(Plain(), {.sets = 100, .apart = 0.3, .starts = 100});
  ASSERT_GT(found.points.size(), 2U);
  for (std::size_t a = 0; a < found.points.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_GE(calibrate::ShareDistance(found.points[a], found.points[b]), 0.3);
    }
  }
  EXPECT_EQ(found.counts.searches, 100);
  EXPECT_EQ(found.counts.too_near, 100 - static_cast<int>(found.points.size()));
  EXPECT_EQ(found.counts.missed + found.counts.rejected, 0);
}

TEST(FindPointsTest, SearchesFromAStartToWhereTheTargetIsMet) {
  const auto found = Find(Valley(), {.sets = 3, .within = 1, .apart = 0.1, .starts = 20});
  ASSERT_EQ(found.points.size(), 3U);
  for (const Shares& point : found.points) EXPECT_NEAR(point[0], 0.5, 0.05);
  EXPECT_GT(found.counts.evaluations, 20);
}

TEST(FindPointsTest, RejectsAndCountsPointsThatFailOnFreshSeeds) {
  // GIVEN fresh seeds with which a point meets the target only if its second field lies in the
  // upper half of the field's range
  calibrate::Landscape landscape = Valley();
  landscape.fresh = [](const Shares& shares) { return shares[1] > 0.5 ? 0.9 : 1.1; };
  const auto found = Find(landscape, {.sets = 50, .apart = 0.02, .starts = 40});
  ASSERT_FALSE(found.points.empty());
  for (const Shares& point : found.points) EXPECT_GT(point[1], 0.5);
  EXPECT_GT(found.counts.rejected, 0);
  EXPECT_EQ(static_cast<int>(found.points.size()) + found.counts.rejected + found.counts.too_near +
                found.counts.missed,
            found.counts.searches);
}

TEST(FindPointsTest, CountsSearchesThatDoNotMeetTheTarget) {
  calibrate::Landscape landscape = Plain();
  landscape.searched = [](const Shares& shares) { return 4 + shares[0]; };
  const auto found = Find(landscape, {.sets = 1, .starts = 5, .evaluations = 30});
  EXPECT_TRUE(found.points.empty());
  EXPECT_EQ(found.counts.missed, 5);
  EXPECT_FALSE(found.interrupted);
}

TEST(FindPointsTest, MeasuresAndKeepsThePointsOfRoundedValues) {
  // GIVEN a field with three values
  calibrate::Landscape landscape = Plain();
  landscape.rounded = [](const Shares& shares) {
    return Shares{std::round(shares[0] * 2) / 2, shares[1]};
  };
  const auto found = Find(landscape, {.sets = 5, .apart = 0.1, .starts = 30});
  ASSERT_EQ(found.points.size(), 5U);
  for (const Shares& point : found.points) EXPECT_EQ(point[0] * 2, std::round(point[0] * 2));
}

TEST(FindPointsTest, DependsOnlyOnLandscapeAndRules) {
  const calibrate::EnsembleRules rules{.sets = 4, .apart = 0.1, .starts = 30};
  const auto found = Find(Valley(), rules);
  EXPECT_EQ(Find(Valley(), rules).points, found.points);
  calibrate::EnsembleRules other = rules;
  other.seed = 2;
  EXPECT_NE(Find(Valley(), other).points, found.points);
}

TEST(FindPointsTest, KeepsWhatItHasFoundWhenItIsStopped) {
  calibrate::Landscape landscape = Valley();
  const calibrate::EnsembleRules rules{.sets = 4, .apart = 0.1, .starts = 30};
  const auto whole = Find(landscape, rules);
  ASSERT_EQ(whole.points.size(), 4U);
  // WHEN the search is stopped after half of its evaluations
  int left = whole.counts.evaluations / 2;
  landscape.searched = [&, valley = Valley().searched](const Shares& shares) {
    return left-- > 0 ? valley(shares) : std::nullopt;
  };
  const auto part = Find(landscape, rules);
  // THEN the result has the first points of the whole search
  EXPECT_TRUE(part.interrupted);
  ASSERT_LT(part.points.size(), 4U);
  EXPECT_TRUE(std::equal(part.points.begin(), part.points.end(), whole.points.begin()));
  EXPECT_EQ(part.counts.evaluations, whole.counts.evaluations / 2);
}

TEST(FindPointsTest, IsStoppedBeforeItsFirstEvaluation) {
  calibrate::Landscape landscape = Plain();
  landscape.searched = [](const Shares&) { return std::optional<double>(); };
  const auto found = Find(landscape, {});
  EXPECT_TRUE(found.interrupted);
  EXPECT_TRUE(found.points.empty());
  EXPECT_EQ(found.counts.searches, 0);
}

TEST(FindPointsTest, TellsHowManyPointsThereAreAfterEachEvaluation) {
  int evaluations = 0;
  int points = 0;
  calibrate::FindPoints(Valley(), {.sets = 3, .apart = 0.1, .starts = 20},
                        [&](int found, const calibrate::EnsembleCounts& counts) {
                          EXPECT_EQ(counts.evaluations, ++evaluations);
                          EXPECT_GE(found, points);
                          points = found;
                        });
  EXPECT_GT(evaluations, 20);
}

TEST(MinimiseTest, PassesOnExceptionsOfTheFunction) {
  const calibrate::FunctionOfShares broken = [](const Shares&) -> std::optional<double> {
    throw std::out_of_range("broken");
  };
  for (const auto reach : {calibrate::Reach::kWholeRange, calibrate::Reach::kAroundStart}) {
    EXPECT_THROW(calibrate::Minimise(reach, broken, {0.5, 0.5}, 0, 10), std::out_of_range);
  }
}

}  // namespace
}  // namespace fogline
