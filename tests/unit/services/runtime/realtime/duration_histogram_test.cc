#include "services/runtime/realtime/duration_histogram.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "common/random.h"

namespace fogline {
namespace {

using std::chrono::microseconds;
using std::chrono::nanoseconds;

TEST(DurationHistogramTest, KnowsNothingOfNothing) {
  const runtime::DurationHistogram histogram;
  EXPECT_EQ(histogram.count(), 0);
  EXPECT_EQ(histogram.QuantileUs(0.99), 0);
  EXPECT_EQ(histogram.MaxUs(), 0);
}

TEST(DurationHistogramTest, IsExactBelow128Microseconds) {
  runtime::DurationHistogram histogram;
  for (int us = 1; us <= 100; ++us) histogram.Add(microseconds(us));
  EXPECT_EQ(histogram.QuantileUs(0), 1);
  EXPECT_EQ(histogram.QuantileUs(0.5), 50);
  EXPECT_EQ(histogram.QuantileUs(0.99), 99);
  EXPECT_EQ(histogram.QuantileUs(1), 100);
  EXPECT_EQ(histogram.MaxUs(), 100);
}

TEST(DurationHistogramTest, CountsWhatIsOutsideItsRangeAtItsEnds) {
  runtime::DurationHistogram histogram;
  histogram.Add(microseconds(-5));
  EXPECT_EQ(histogram.QuantileUs(1), 0);
  histogram.Add(std::chrono::hours(10));
  EXPECT_EQ(histogram.MaxUs(), runtime::DurationHistogram::kMaxUs);
  EXPECT_EQ(histogram.QuantileUs(1), runtime::DurationHistogram::kMaxUs);
  EXPECT_EQ(histogram.count(), 2);
}

TEST(DurationHistogramTest, RoundsUpToMicroseconds) {
  runtime::DurationHistogram histogram;
  histogram.Add(nanoseconds(1));
  EXPECT_EQ(histogram.MaxUs(), 1);
}

// The histogram knows its largest duration exactly. So the quantile of a single duration is exact.
// If a larger duration is added, the quantile of the smaller duration is rounded up to the end of
// the smaller duration's cell.
TEST(DurationHistogramTest, IsTooLargeByAtMostASixtyFourthAndNeverTooSmall) {
  for (std::int64_t us = 1; us < runtime::DurationHistogram::kMaxUs / 2; us += 1 + us / 97) {
    runtime::DurationHistogram histogram;
    histogram.Add(microseconds(us));
    EXPECT_EQ(histogram.QuantileUs(1), us);
    histogram.Add(microseconds(runtime::DurationHistogram::kMaxUs));
    const std::int64_t median = histogram.QuantileUs(0.5);
    ASSERT_GE(median, us);
    ASSERT_LE(median - us, us / 64) << us;
  }
}

TEST(DurationHistogramTest, AgreesWithSorting) {
  const Random random(3, Stream::kRadar);
  runtime::DurationHistogram histogram;
  std::vector<std::int64_t> all;
  for (std::int64_t i = 0; i < 20'000; ++i) {
    // A latency with a long tail: often a factor of e above or below 300 us.
    all.push_back(static_cast<std::int64_t>(300 * std::exp(random.Normal2(i, 0)[0])));
    histogram.Add(microseconds(all.back()));
  }
  std::ranges::sort(all);
  for (const double q : {0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const std::int64_t exact =
        all[static_cast<std::size_t>(std::ceil(q * static_cast<double>(all.size()))) - 1];
    EXPECT_GE(histogram.QuantileUs(q), exact) << q;
    EXPECT_LE(histogram.QuantileUs(q), exact + exact / 64) << q;
  }
}

}  // namespace
}  // namespace fogline
