#include "tools/watch/arrivals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/tools/watch/now.h"

namespace fogline {
namespace {

constexpr Duration kSecond = milliseconds(1000);
// Times are whole milliseconds, so only the rounding of sums of doubles matters.
constexpr double kRounding = 1e-12;

TEST(ArrivalsTest, MeasuresRateBandwidthAndAgeOfAnInterval) {
  // GIVEN 5 messages of 100 bytes in 2 s, the last one 0.5 s before the end
  watch::Arrivals arrivals;
  for (int i = 0; i < 5; ++i) arrivals.Add(100, kNow + milliseconds(500 + 250 * i));
  const watch::ArrivalView view = arrivals.Observe(kNow + 2 * kSecond, 2 * kSecond);
  EXPECT_EQ(view.messages, 5);
  EXPECT_DOUBLE_EQ(view.rate_hz, 2.5);
  EXPECT_DOUBLE_EQ(view.bandwidth_bytes_per_s, 250);
  EXPECT_NEAR(view.age_s, 0.5, kRounding);
}

TEST(ArrivalsTest, CallsTheStandardDeviationOfTheGapsJitter) {
  // GIVEN gaps of 100, 120, 80 and 100 ms: mean 100, squared deviations 0 + 400 + 400 + 0
  watch::Arrivals arrivals;
  for (const int at_ms : {0, 100, 220, 300, 400}) arrivals.Add(1, kNow + milliseconds(at_ms));
  const watch::ArrivalView view = arrivals.Observe(kNow + kSecond, kSecond);
  ASSERT_TRUE(view.jitter_s);
  EXPECT_NEAR(*view.jitter_s, 1e-3 * std::sqrt(800.0 / 3), kRounding);
  EXPECT_NEAR(view.longest_gap_s.value(), 0.120, kRounding);
}

TEST(ArrivalsTest, HasNoJitterOfEvenGaps) {
  watch::Arrivals arrivals;
  for (int i = 0; i < 100; ++i) arrivals.Add(1, kNow + milliseconds(10 * i));
  EXPECT_NEAR(arrivals.Observe(kNow + kSecond, kSecond).jitter_s.value(), 0, kRounding);
}

TEST(ArrivalsTest, SaysNothingOfGapsThatItHasNotSeen) {
  watch::Arrivals arrivals;
  arrivals.Add(1, kNow);
  EXPECT_FALSE(arrivals.Observe(kNow + kSecond, kSecond).longest_gap_s);
  // The interval has one gap, which began in the previous interval. One gap is enough for the
  // longest gap, but not for a deviation.
  arrivals.Add(1, kNow + milliseconds(1300));
  const watch::ArrivalView view = arrivals.Observe(kNow + 2 * kSecond, kSecond);
  EXPECT_NEAR(view.longest_gap_s.value(), 1.3, kRounding);
  EXPECT_FALSE(view.jitter_s);
}

TEST(ArrivalsTest, StartsOverInEachIntervalExceptTheCount) {
  watch::Arrivals arrivals;
  for (int i = 0; i < 10; ++i) arrivals.Add(50, kNow + milliseconds(i));
  arrivals.Observe(kNow + kSecond, kSecond);
  const watch::ArrivalView quiet = arrivals.Observe(kNow + 2 * kSecond, kSecond);
  EXPECT_EQ(quiet.messages, 10);
  EXPECT_EQ(quiet.rate_hz, 0);
  EXPECT_EQ(quiet.bandwidth_bytes_per_s, 0);
  EXPECT_FALSE(quiet.jitter_s);
  EXPECT_FALSE(quiet.longest_gap_s);
  EXPECT_NEAR(quiet.age_s, 1.991, kRounding);
}

}  // namespace
}  // namespace fogline
