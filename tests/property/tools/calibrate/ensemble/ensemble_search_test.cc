// The search for an ensemble, on functions with several minima at known points.
#include "tools/calibrate/ensemble/ensemble_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace fogline {
namespace {

using Shares = std::vector<double>;

// A point meets the target if it is within this radius of a minimum. Two minima are at least kApart
// apart.
constexpr double kRadius = 0.02;
constexpr double kApart = 0.3;

/// Four minima, as shares of the ranges of three fields. The function that stands for the fresh
/// seeds has only the first three. So the search must reject the last minimum.
const std::array<Shares, 4> kMinima{
    {{0.2, 0.2, 0.8}, {0.8, 0.7, 0.2}, {0.25, 0.8, 0.3}, {0.75, 0.2, 0.5}}};

std::size_t NearestMinimum(const Shares& point, std::size_t minima) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < minima; ++i) {
    if (calibrate::ShareDistance(point, kMinima[i]) <
        calibrate::ShareDistance(point, kMinima[nearest])) {
      nearest = i;
    }
  }
  return nearest;
}

/// The square of the distance (in units of kRadius) from the nearest of the first `minima` minima,
/// plus small waves, which add local minima.
double Value(const Shares& point, std::size_t minima) {
  const double off = calibrate::ShareDistance(point, kMinima[NearestMinimum(point, minima)]);
  const double wave = 0.1 * (1 - std::cos(200 * off));
  return off / kRadius * (off / kRadius) + wave;
}

class EnsembleSearchPropertyTest : public ::testing::TestWithParam<std::int64_t> {
 protected:
  static calibrate::PointEnsemble Find(std::int64_t seed) {
    const calibrate::Landscape landscape{
        .fields = 3,
        .searched = [](const Shares& shares) { return Value(shares, kMinima.size()); },
        .fresh = [](const Shares& shares) { return Value(shares, kMinima.size() - 1); },
        .rounded = [](const Shares& shares) { return shares; }};
    const calibrate::EnsembleRules rules{
        .sets = 4, .apart = kApart, .starts = 60, .evaluations = 400, .seed = seed};
    return calibrate::FindPoints(landscape, rules, [](int, const calibrate::EnsembleCounts&) {});
  }
};

TEST_P(EnsembleSearchPropertyTest, FindsEveryMinimumOnce) {
  const calibrate::PointEnsemble found = Find(GetParam());
  std::set<std::size_t> minima;
  for (const Shares& point : found.points) {
    const std::size_t minimum = NearestMinimum(point, kMinima.size());
    EXPECT_LE(calibrate::ShareDistance(point, kMinima[minimum]), kRadius);
    EXPECT_TRUE(minima.insert(minimum).second) << "twice minimum " << minimum;
  }
  EXPECT_EQ(minima, (std::set<std::size_t>{0, 1, 2}));
}

TEST_P(EnsembleSearchPropertyTest, RejectsTheMinimumThatFreshSeedsDoNotHave) {
  const calibrate::PointEnsemble found = Find(GetParam());
  EXPECT_GE(found.counts.rejected, 1);
  EXPECT_EQ(found.counts.searches, found.counts.missed + found.counts.too_near +
                                       found.counts.rejected +
                                       static_cast<int>(found.points.size()));
}

INSTANTIATE_TEST_SUITE_P(Seeds, EnsembleSearchPropertyTest, ::testing::Range<std::int64_t>(1, 21));

}  // namespace
}  // namespace fogline
