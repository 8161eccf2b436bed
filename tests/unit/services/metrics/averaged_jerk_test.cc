#include "services/metrics/averaged_jerk.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include <gtest/gtest.h>

namespace fogline {
namespace {

/// The time of a step, rounded to whole microseconds as in a log.
double TimeOf(std::int64_t step, double step_s) {
  return static_cast<double>(std::llround(1e6 * step_s * static_cast<double>(step))) * 1e-6;
}

/// The largest averaged jerk of `acceleration(t)`, applied for 10 s.
template <class Acceleration>
double LargestOf(Acceleration acceleration, double step_s) {
  metrics::AveragedJerk jerk;
  double largest = -1;
  for (std::int64_t k = 1; TimeOf(k, step_s) <= 10; ++k) {
    const double now_s = TimeOf(k, step_s);
    largest = std::max(largest, jerk.Add(now_s, acceleration(now_s)).value_or(-1));
  }
  return largest;
}

TEST(AveragedJerkTest, HasNoValueBeforeAWholeSecondIsKnown) {
  metrics::AveragedJerk jerk;
  EXPECT_EQ(jerk.Add(0.5, 1), std::nullopt);
  EXPECT_EQ(jerk.Add(1.0, 3), std::nullopt);
  EXPECT_EQ(jerk.Add(1.5, 2), 1);  // from 1 at 0.5 s to 2
  EXPECT_EQ(jerk.Add(2.0, 2), 1);  // from 3 at 1.0 s to 2
}

TEST(AveragedJerkTest, OfAJumpIsTheJumpWhateverTheStepIs) {
  // A hand-over at 4 s: the acceleration jumps by 0.6 m/s2 from one step to the next.
  const auto jump = [](double time_s) { return time_s > 4 + 1e-9 ? 0.4 : -0.2; };
  for (const double step_s : {0.1, 0.05, 0.02, 0.001, 1.0, 0.3}) {
    EXPECT_NEAR(LargestOf(jump, step_s), 0.6, 1e-12) << step_s;
  }
}

TEST(AveragedJerkTest, OfARampIsItsSlopeOrItsHeightWhateverTheStepIs) {
  for (const double step_s : {0.1, 0.05, 0.02}) {
    const auto long_ramp = [](double t) { return 2.5 * std::clamp(t - 3, 0.0, 2.0); };
    EXPECT_NEAR(LargestOf(long_ramp, step_s), 2.5, 1e-9) << step_s;
    // A ramp of half a second: its jerk is 2.5 m/s3, and the average over 1 s is half of this
    // value.
    const auto short_ramp = [](double t) { return 2.5 * std::clamp(t - 3, 0.0, 0.5); };
    EXPECT_NEAR(LargestOf(short_ramp, step_s), 1.25, 1e-9) << step_s;
  }
}

TEST(AveragedJerkTest, OfASpikeShorterThanTheWindowCountsItsHeight) {
  const auto spike = [](double t) { return t > 5 + 1e-9 && t < 5.2 + 1e-9 ? -3.0 : 0.0; };
  for (const double step_s : {0.1, 0.05, 0.02}) {
    EXPECT_NEAR(LargestOf(spike, step_s), 3, 1e-12) << step_s;
  }
}

TEST(AveragedJerkTest, TakesTheAccelerationThatHeldOneSecondAgo) {
  // Steps of 0.4 s: one second before 2.0 s is 1.0 s, in the step that ends at 1.2 s.
  metrics::AveragedJerk jerk;
  EXPECT_EQ(jerk.Add(0.4, 1), std::nullopt);
  EXPECT_EQ(jerk.Add(0.8, 2), std::nullopt);
  EXPECT_EQ(jerk.Add(1.2, 4), std::nullopt);
  EXPECT_EQ(jerk.Add(1.6, 8), 6);    // 2 at 0.6 s, in the step from 0.4 s to 0.8 s
  EXPECT_EQ(jerk.Add(2.0, 16), 12);  // 4 at 1.0 s
}

TEST(AveragedJerkTest, LooksAtTheNextKnownStepAfterAHole) {
  metrics::AveragedJerk jerk;
  EXPECT_EQ(jerk.Add(0.1, 1), std::nullopt);
  EXPECT_EQ(jerk.Add(5.0, 4), 0);  // only the end of the last second is known
  EXPECT_EQ(jerk.Add(6.0, 6), 2);
}

}  // namespace
}  // namespace fogline
