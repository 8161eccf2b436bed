#include "tools/web/log/series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace fogline::web {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

auto Of(const std::vector<double>& values) {
  return [&values](std::int64_t step) -> std::optional<SeriesPoint> {
    return SeriesPoint{.time_s = 0.1 * static_cast<double>(step),
                       .value = values[static_cast<std::size_t>(step)]};
  };
}

TEST(SeriesTest, GivesEveryValueIfTheyAreFew) {
  const std::vector<double> values{3, 1, kNone, 2};
  const Series series = Decimate(0, 3, 2, Of(values));
  ASSERT_EQ(series.value.size(), 4U);
  EXPECT_EQ(series.value[1], 1);
  EXPECT_TRUE(std::isnan(series.value[2]));
  EXPECT_EQ(series.time_s[3], 0.1 * 3);
  EXPECT_TRUE(series.whole);
}

TEST(SeriesTest, LosesNoPeak) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (const std::int64_t steps : {11, 100, 999, 10'000}) {
    std::vector<double> values(static_cast<std::size_t>(steps));
    for (double& value : values) value = normal(random);
    for (const std::int64_t points : {1, 3, 5, 50}) {
      const Series series = Decimate(0, steps - 1, points, Of(values));
      EXPECT_LE(series.value.size(), static_cast<std::size_t>(2 * points));
      EXPECT_EQ(std::ranges::min(series.value), std::ranges::min(values));
      EXPECT_EQ(std::ranges::max(series.value), std::ranges::max(values));
      EXPECT_TRUE(std::ranges::is_sorted(series.time_s));
      EXPECT_EQ(series.whole, steps <= 2 * points);
    }
  }
}

TEST(SeriesTest, HasAGapWhereNoStepHasAValue) {
  std::vector<double> values(100, 1.0);
  std::fill(values.begin() + 40, values.begin() + 60, kNone);
  const Series series = Decimate(0, 99, 10, Of(values));
  EXPECT_EQ(std::ranges::count_if(series.value, [](double value) { return std::isnan(value); }), 2);
}

TEST(SeriesTest, LeavesOutStepsWithoutAMessage) {
  const auto odd = [](std::int64_t step) -> std::optional<SeriesPoint> {
    if (step % 2 == 0) return std::nullopt;
    return SeriesPoint{.time_s = static_cast<double>(step), .value = 1};
  };
  EXPECT_EQ(Decimate(0, 9, 100, odd).value.size(), 5U);
  EXPECT_EQ(Decimate(5, 4, 100, odd).value.size(), 0U);
}

TEST(SeriesTest, HasEachChangeOfAValueThatSeldomChanges) {
  const std::vector<double> values{0, 0, 3, 3, kNone, kNone, 3, 0, 0};
  const auto changes = Changes(0, 8, 5, Of(values));
  ASSERT_TRUE(changes);
  ASSERT_EQ(changes->value.size(), 5U);
  EXPECT_EQ(changes->time_s, (std::vector<double>{0, 0.2, 0.1 * 4, 0.1 * 6, 0.1 * 7}));
  EXPECT_EQ(changes->value[1], 3);
  EXPECT_TRUE(std::isnan(changes->value[2]));
  EXPECT_EQ(changes->value[4], 0);
  EXPECT_FALSE(Changes(0, 8, 4, Of(values)));
  EXPECT_EQ(Changes(1, 1, 4, Of(values))->value.size(), 1U);
}

}  // namespace
}  // namespace fogline::web
