#include "services/models/follower/safe_distance.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

models::Situation Behind(double speed_mps, double gap_m, double lead_mps, double own_mps2 = 0) {
  return {.speed_mps = speed_mps,
          .acceleration_mps2 = own_mps2,
          .ahead = models::CarAhead{.gap_m = gap_m, .speed_mps = lead_mps}};
}

TEST(SafeDistanceTest, RssIsAsWorkedByHand) {
  // With the default parameters, the distance is 20 + 1.75 + 23.5^2 / 8 - 400 / 16 m.
  EXPECT_NEAR(models::RssSafeDistance({}, 20, 20), 65.78125, 1e-9);
  // With the parameters `tuned`, the distance is 10 + 0.25 + 21^2 / 12 - 400 / 16 m.
  const models::RssParameters tuned{
      .response_s = 0.5, .acceleration_mps2 = 2, .least_braking_mps2 = 6, .most_braking_mps2 = 8};
  EXPECT_NEAR(models::RssSafeDistance(tuned, 20, 20), 22, 1e-9);
}

TEST(SafeDistanceTest, RssIsNeverNegative) { EXPECT_EQ(models::RssSafeDistance({}, 0, 40), 0); }

TEST(SafeDistanceTest, ProactiveFuzzyIsAsWorkedByHand) {
  // Both cars drive at 20 m/s. By the equations of the header, d_safe = 15 + 50 - 28.571 + 2 =
  // 38.429 m and d_unsafe = 15 + 33.333 - 28.571 = 19.762 m. The gap of 2 m at standstill is added
  // to both.
  EXPECT_EQ(models::ProactiveFuzzy({}, Behind(20, 40.43, 20)), 0);
  EXPECT_EQ(models::ProactiveFuzzy({}, Behind(20, 21.76, 20)), 1);
  EXPECT_NEAR(models::ProactiveFuzzy({}, Behind(20, 2 + 0.5 * (38.4286 + 19.7619), 20)), 0.5, 1e-5);
  EXPECT_EQ(models::ProactiveFuzzy({}, {.speed_mps = 20}), 0);
}

TEST(SafeDistanceTest, CriticalFuzzyIsAsWorkedByHand) {
  // At a closing speed of 10 m/s, d_safe = 7.5 + 100 / 8 = 20 m and d_unsafe = 7.5 + 100 / 12 =
  // 15.833 m.
  EXPECT_EQ(models::CriticalFuzzy({}, Behind(20, 20, 10)), 0);
  EXPECT_EQ(models::CriticalFuzzy({}, Behind(20, 15.83, 10)), 1);
  EXPECT_NEAR(models::CriticalFuzzy({}, Behind(20, 0.5 * (20 + 15.83333), 10)), 0.5, 1e-6);
  EXPECT_EQ(models::CriticalFuzzy({}, Behind(10, 1, 10)), 0);
  // A car that closes at 2 m/s and already brakes at 4 m/s2 stops closing after half a second and
  // 0.5 m.
  EXPECT_EQ(models::CriticalFuzzy({}, Behind(12, 0.49, 10, -4)), 1);
  EXPECT_EQ(models::CriticalFuzzy({}, Behind(12, 0.51, 10, -4)), 0);
}

TEST(SafeDistanceTest, CriticalFuzzyCountsOnComfortableBrakingAtMost) {
  // The car closes at 10 m/s and brakes at 8 m/s2. The model counts only 4 m/s2 of this braking, so
  // d_safe = 8.5 * 0.75 + 7^2 / 8 = 12.5 m.
  EXPECT_EQ(models::CriticalFuzzy({}, Behind(20, 12.5, 10, -8)), 0);
  EXPECT_GT(models::CriticalFuzzy({}, Behind(20, 12.4, 10, -8)), 0);
}

TEST(SafeDistanceTest, FuzzyBrakesComfortablyFirstAndHarderWhenCritical) {
  EXPECT_EQ(models::FuzzyDeceleration({}, Behind(20, 100, 20)), 0);
  EXPECT_NEAR(models::FuzzyDeceleration({}, Behind(20, 2 + 0.5 * (38.4286 + 19.7619), 20)), 2,
              1e-4);
  EXPECT_EQ(models::FuzzyDeceleration({}, Behind(20, 15.8, 10)), 6);
}

}  // namespace
}  // namespace fogline
