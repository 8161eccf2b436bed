#include "services/arbitrator/arbitrator.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include <gtest/gtest.h>

#include "common/random.h"

namespace fogline {
namespace {

constexpr auto kAbsolute = ConflictReading::kMeanOfAbsolute;
constexpr auto kSigned = ConflictReading::kAbsoluteOfMean;

// Draws a difference between the sensors, with a standard deviation of 1 m. With a probability of
// 0.2 the step has no difference.
std::optional<double> AnyDifference(const Random& random, std::int64_t step) {
  if (random.Uniform2(step, 0)[0] < 0.2) return std::nullopt;
  return random.Normal2(step, 1)[0];
}

TEST(DegreeOfConflictPropertyTest, GrowsWithTheConflictAndIsSymmetricAboutTheCentre) {
  for (const double slope : {0.5, 10.0, 40.0}) {
    for (double z = 0; z < 2; z += 0.01) {
      const double doc = conflict::DegreeOfConflict(z, slope, 1);
      EXPECT_GE(doc, 0);
      EXPECT_LE(doc, 1);
      // The DoC grows strictly until rounding makes it 1.
      if (doc < 1 - 1e-12) {
        EXPECT_LT(doc, conflict::DegreeOfConflict(z + 0.01, slope, 1));
      }
      EXPECT_NEAR(doc + conflict::DegreeOfConflict(2 - z, slope, 1), 1, 1e-13);
    }
  }
}

// The window must agree exactly with a simple window made of a deque and loops. The test shows that
// the sums of the window do not drift, and that the window contains no old value.
TEST(ConflictWindowPropertyTest, AveragesTheLastStepsAndNothingElse) {
  for (const std::size_t length : {1, 2, 7, 8, 50}) {
    conflict::ConflictWindow window(static_cast<int>(length));
    std::deque<std::optional<double>> last;
    const Random random(static_cast<std::int64_t>(length), Stream::kLidar);
    for (int k = 0; k < 2000; ++k) {
      last.push_back(AnyDifference(random, k));
      if (last.size() > length) last.pop_front();
      window.Push(last.back());
      double sum = 0;
      double absolute_sum = 0;
      int count = 0;
      for (const auto& difference : last) {
        if (!difference) continue;
        sum += *difference;
        absolute_sum += std::abs(*difference);
        ++count;
      }
      ASSERT_EQ(window.Conflict(kAbsolute), count == 0 ? 0 : absolute_sum / count);
      ASSERT_EQ(window.Conflict(kSigned), count == 0 ? 0 : std::abs(sum / count));
    }
  }
}

TEST(ConflictWindowPropertyTest, ConflictDependsOnTheWindowAloneToTheLastBit) {
  constexpr int kLength = 8;
  const Random random(1, Stream::kLidar);
  for (int history = 0; history < 3 * kLength; ++history) {
    conflict::ConflictWindow young(kLength);
    conflict::ConflictWindow old(kLength);
    for (int k = 0; k < history; ++k) old.Push(1e9 * random.Normal2(k, 5)[0]);
    for (int k = 0; k < kLength; ++k) {
      young.Push(AnyDifference(random, k));
      old.Push(AnyDifference(random, k));
    }
    EXPECT_EQ(young.Conflict(kAbsolute), old.Conflict(kAbsolute)) << history;
    EXPECT_EQ(young.Conflict(kSigned), old.Conflict(kSigned)) << history;
  }
}

TEST(ConflictWindowPropertyTest, MeanOfAbsoluteIsNeverBelowTheOtherReading) {
  conflict::ConflictWindow window(6);
  const Random random(2, Stream::kLidar);
  for (int k = 0; k < 2000; ++k) {
    window.Push(AnyDifference(random, k));
    const double absolute = window.Conflict(kAbsolute);
    ASSERT_GE(absolute * (1 + 1e-15), window.Conflict(kSigned));  // the factor allows for rounding
    ASSERT_GE(window.Conflict(kSigned), 0);
  }
}

TEST(ArbitratorPropertyTest, PassesOneOfTheTwoOffersOnAsTheThresholdSays) {
  for (const MissingLidar missing :
       {MissingLidar::kHold, MissingLidar::kSkip, MissingLidar::kConflict}) {
    for (const double threshold : {0.0, 0.2, 0.5, 0.8, 1.0}) {
      Scenario scenario;
      scenario.arbitrator.threshold = threshold;
      scenario.arbitrator.missing_lidar = missing;
      arbitrator::Arbitrator arbitrator(scenario);
      const Random random(3, Stream::kLidar);
      for (int k = 0; k < 500; ++k) {
        ego_t ego{};
        radar_t radar{};
        lidar_t lidar{};
        accel_command_t automation{};
        driver_command_t driver{};
        radar.valid = random.Uniform2(k, 0)[0] < 0.9;
        lidar.valid = random.Uniform2(k, 0)[1] < 0.9;
        radar.range_m = 31 + 0.3 * random.Normal2(k, 1)[0];
        lidar.range_m = 30 + 0.3 * random.Normal2(k, 1)[1];
        automation.acceleration_mps2 = random.Normal2(k, 2)[0];
        driver.acceleration_mps2 = random.Normal2(k, 2)[1];
        const arbitration_t& out =
            arbitrator.Step(ego, radar, lidar, track_t{}, automation, driver);
        const bool automated = 0 <= out.doc && out.doc < threshold;
        ASSERT_EQ(out.lambda_automation, automated ? 1 : 0);
        ASSERT_EQ(out.lambda_automation + out.lambda_human, 1);
        ASSERT_EQ(out.mode, automated ? arbitration_t::AUTOMATION : arbitration_t::HUMAN);
        ASSERT_EQ(out.acceleration_mps2,
                  automated ? automation.acceleration_mps2 : driver.acceleration_mps2);
        ASSERT_GE(out.conflict_m, 0);
      }
    }
  }
}

TEST(ArbitratorPropertyTest, ConstantConflictCrossesTheThresholdAtItsInverse) {
  // The DoC of a constant conflict z reaches the threshold th at z = 1 m + ln(th / (1 - th)) / 10.
  // For the paper's thresholds this is 0.861 m, 1 m and 1.139 m.
  for (const double threshold : {0.2, 0.5, 0.8}) {
    const double z = 1 + std::log(threshold / (1 - threshold)) / 10;
    for (const double side : {-1.0, 1.0}) {
      Scenario scenario;
      scenario.arbitrator.threshold = threshold;
      arbitrator::Arbitrator arbitrator(scenario);
      radar_t radar{};
      lidar_t lidar{};
      radar.valid = lidar.valid = 1;
      radar.range_m = 30 + z + side * 1e-9;
      lidar.range_m = 30;
      for (int k = 0; k < 20; ++k) {
        const arbitration_t& out = arbitrator.Step(ego_t{}, radar, lidar, track_t{},
                                                   accel_command_t{}, driver_command_t{});
        ASSERT_EQ(out.lambda_human, side > 0 ? 1 : 0) << threshold << " at step " << k;
      }
    }
  }
}

}  // namespace
}  // namespace fogline
