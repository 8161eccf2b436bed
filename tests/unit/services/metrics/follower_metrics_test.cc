#include "services/metrics/follower_metrics.h"

#include <map>
#include <string>

#include <gtest/gtest.h>

namespace fogline {
namespace {

// Two following cars with gaps of 30 m and 20 m to the car ahead. All cars drive at 20 m/s.
truth_t TwoFollowers() {
  truth_t truth{};
  truth.host_speed_mps = 20;
  truth.num_followers = 2;
  truth.follower_position_m = {-34.5, -59};
  truth.follower_speed_mps = {20, 20};
  truth.follower_acceleration_mps2 = {0, 0};
  truth.follower_gap_m = {30, 20};
  return truth;
}

follower_command_t SafeDistances(double first_m, double second_m) {
  follower_command_t command{};
  command.num_followers = 2;
  command.acceleration_mps2 = {0, 0};
  command.safe_distance_m = {first_m, second_m};
  return command;
}

TEST(FollowerMetricsTest, AreNoneWithoutAFollower) {
  metrics::FollowerAccumulator accumulator;
  accumulator.Add(truth_t{}, follower_command_t{});
  EXPECT_TRUE(accumulator.Result().empty());
}

TEST(FollowerMetricsTest, HaveTheSmallestGapOfEachCar) {
  metrics::FollowerAccumulator accumulator;
  truth_t truth = TwoFollowers();
  for (const double less_m : {0.0, 3.0, 1.0}) {
    truth.follower_gap_m = {30 - less_m, 20 - 2 * less_m};
    accumulator.Add(truth, SafeDistances(0, 0));
  }
  const auto result = accumulator.Result();
  ASSERT_EQ(result.size(), 2U);
  EXPECT_EQ(result[0].min_gap_m, 27);
  EXPECT_EQ(result[1].min_gap_m, 14);
}

TEST(FollowerMetricsTest, HaveTheTimeToCollisionWithTheCarBefore) {
  metrics::FollowerAccumulator accumulator;
  truth_t truth = TwoFollowers();
  accumulator.Add(truth, SafeDistances(0, 0));
  EXPECT_EQ(accumulator.Result()[0].min_ttc_s, std::nullopt) << "no car closes in";
  // WHEN the first car approaches the host at 5 m/s, and the second car approaches the first car
  // at 2 m/s
  truth.follower_speed_mps = {25, 27};
  accumulator.Add(truth, SafeDistances(0, 0));
  // THEN the TTC is 6 s over the first gap of 30 m, and 10 s over the second gap of 20 m
  EXPECT_EQ(accumulator.Result()[0].min_ttc_s, 6);
  EXPECT_EQ(accumulator.Result()[1].min_ttc_s, 10);
  // AND once two cars touch, their TTC is 0
  truth.follower_gap_m[0] = -1;
  accumulator.Add(truth, SafeDistances(0, 0));
  EXPECT_EQ(accumulator.Result()[0].min_ttc_s, 0);
}

TEST(FollowerMetricsTest, HaveTheShortfallOfEachDriversOwnSafeDistance) {
  metrics::FollowerAccumulator accumulator;
  truth_t truth = TwoFollowers();
  accumulator.Add(truth, SafeDistances(32, 20));
  EXPECT_EQ(accumulator.Result()[0].mean_compromised_safety_fog_m, std::nullopt) << "no fog yet";
  truth.fog_present = 1;
  accumulator.Add(truth, SafeDistances(31, 24));
  accumulator.Add(truth, SafeDistances(29, 25));
  const auto result = accumulator.Result();
  EXPECT_EQ(result[0].max_compromised_safety_m, 2);
  EXPECT_EQ(result[0].mean_compromised_safety_fog_m, 0.5);
  EXPECT_EQ(result[1].max_compromised_safety_m, 5);
  EXPECT_EQ(result[1].mean_compromised_safety_fog_m, 4.5);
}

TEST(FollowerMetricsTest, GoWithoutTheCommandsOfAStepThatHasNone) {
  metrics::FollowerAccumulator accumulator;
  truth_t truth = TwoFollowers();
  truth.follower_gap_m = {10, 10};
  accumulator.Add(truth, follower_command_t{});
  const auto result = accumulator.Result();
  ASSERT_EQ(result.size(), 2U);
  EXPECT_EQ(result[1].min_gap_m, 10);
  EXPECT_EQ(result[1].max_compromised_safety_m, std::nullopt);
}

TEST(FollowerMetricsTest, AreNamedWithTheirUnits) {
  std::map<std::string, std::string> units;
  metrics::VisitFollowerMetrics(
      metrics::FollowerMetrics(),
      [&](std::string_view name, const auto&, std::string_view unit, std::string_view what) {
        EXPECT_FALSE(what.empty()) << name;
        units.emplace(name, unit);
      });
  EXPECT_EQ(units.size(), 4U);
  for (const auto& [name, unit] : units) EXPECT_TRUE(name.ends_with("_" + unit)) << name;
}

}  // namespace
}  // namespace fogline
