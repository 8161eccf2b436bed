#include "services/models/minimal_risk/minimal_risk.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "common/random.h"
#include "services/models/vehicle/motion.h"

namespace fogline {
namespace {

struct Case {
  MinimalRiskSection limits;
  double step_s;
  double speed_mps;
  double acceleration_mps2;
};

double Between(double low, double high, double u) { return low + (high - low) * u; }

// Parameters from the scenario's ranges: a step from 1 ms to 1 s, an acceleration from full braking
// to full throttle, a speed often near 0.
Case AnyCase(std::int64_t index) {
  const Random random(7, Stream::kRadar);
  const auto [d, j] = random.Uniform2(index, 0);
  const auto [h, v] = random.Uniform2(index, 1);
  const auto [a, _] = random.Uniform2(index, 2);
  return {.limits = {.deceleration_mps2 = Between(0.5, 4, d), .jerk_mps3 = Between(0.5, 20, j)},
          .step_s = std::pow(10, Between(-3, 0, h)),
          .speed_mps = 70 * v * v * v,
          .acceleration_mps2 = Between(-9, 4, a)};
}

// The upper bound for the time to rest (services/models/minimal_risk/README.md).
double LongestTimeToRest(const Case& c) {
  const double d = c.limits.deceleration_mps2;
  const double j = c.limits.jerk_mps3;
  const double push = std::max(c.acceleration_mps2, 0.0);
  return std::abs(c.acceleration_mps2 + d) / j +
         (c.speed_mps + push * push / (2 * j) + push * c.step_s) / d + d / j + 3 * c.step_s;
}

// Tolerance for the rounding of sums over many steps.
constexpr double kRounding = 1e-9;

struct Drive {
  bool rests = false;
  double rest_s = 0;
  double jump_mps2 = 0;  // largest change of the applied acceleration from one step to the next
};

// Moves a car as the world does until the car stands, and checks the limits in every step.
Drive DriveToRest(const Case& c, std::int64_t index) {
  models::MinimalRisk manoeuvre(c.limits, c.step_s);
  manoeuvre.Begin(c.acceleration_mps2);
  models::Motion motion{0, c.speed_mps};
  const double change = c.limits.jerk_mps3 * c.step_s + kRounding;
  const double hardest = std::max(c.limits.deceleration_mps2, -c.acceleration_mps2) + kRounding;
  double last = c.acceleration_mps2;
  double applied = last;
  Drive drive;
  const auto most = static_cast<std::int64_t>(LongestTimeToRest(c) / c.step_s) + 1;
  for (std::int64_t k = 0; k <= most; ++k) {
    const double command = manoeuvre.Step(motion.speed_mps);
    if (motion.speed_mps == 0 && command == 0) {
      drive.rests = true;
      drive.rest_s = static_cast<double>(k) * c.step_s;
      drive.jump_mps2 = std::max(drive.jump_mps2, std::abs(applied));
      return drive;
    }
    EXPECT_TRUE(std::isfinite(command)) << index;
    EXPECT_LE(std::abs(command - last), change) << "case " << index << " step " << k;
    EXPECT_GE(command, -hardest) << "case " << index << " step " << k;
    EXPECT_LE(command, std::max(c.acceleration_mps2, 0.0)) << index;
    const models::Motion next = models::Advance(motion, command, c.step_s);
    EXPECT_GE(next.position_m, motion.position_m - kRounding) << index;
    const double before = applied;
    applied = (next.speed_mps - motion.speed_mps) / c.step_s;  // the mean over the step
    drive.jump_mps2 = std::max(drive.jump_mps2, std::abs(applied - before));
    motion = next;
    last = command;
  }
  return drive;
}

TEST(MinimalRiskPropertyTest, KeepsItsLimitsAndRestsWithinTheBound) {
  for (std::int64_t i = 0; i < 3000; ++i) {
    const Case c = AnyCase(i);
    const Drive drive = DriveToRest(c, i);
    ASSERT_TRUE(drive.rests) << "case " << i << ": " << c.speed_mps << " m/s, "
                             << c.acceleration_mps2 << " m/s2, step " << c.step_s;
    ASSERT_LE(drive.rest_s, LongestTimeToRest(c)) << i;
  }
}

// If the car is fast enough to release its brake before standstill, it stops without a jump.
TEST(MinimalRiskPropertyTest, EndsAsGentlyAsItBegins) {
  int checked = 0;
  for (std::int64_t i = 0; i < 3000; ++i) {
    const Case c = AnyCase(i);
    const double brake = std::max(0.0, -c.acceleration_mps2);
    const double release_mps = brake * brake / (2 * c.limits.jerk_mps3) + brake * c.step_s;
    if (c.speed_mps < release_mps) continue;
    ++checked;
    // The speed before the last step contains the rounding of all earlier steps.
    const double rounding_mps2 = 1e-10 / c.step_s;
    EXPECT_LE(DriveToRest(c, i).jump_mps2 - c.limits.jerk_mps3 * c.step_s, rounding_mps2) << i;
  }
  EXPECT_GT(checked, 1000);
}

TEST(MinimalRiskPropertyTest, NeverDrivesOffAgain) {
  for (std::int64_t i = 0; i < 300; ++i) {
    const Case c = AnyCase(i);
    models::MinimalRisk manoeuvre(c.limits, c.step_s);
    manoeuvre.Begin(c.acceleration_mps2);
    models::Motion motion{0, c.speed_mps};
    const auto most = static_cast<std::int64_t>(LongestTimeToRest(c) / c.step_s) + 1;
    for (std::int64_t k = 0; k < most; ++k) {
      motion = models::Advance(motion, manoeuvre.Step(motion.speed_mps), c.step_s);
    }
    ASSERT_EQ(motion.speed_mps, 0) << i;
    for (int k = 0; k < 100; ++k) ASSERT_EQ(manoeuvre.Step(0), 0) << i;
  }
}

// Noise of the measured speed changes the command, but the command still keeps its limits.
TEST(MinimalRiskPropertyTest, KeepsItsLimitsUnderAnySpeeds) {
  const Random random(11, Stream::kLidar);
  for (std::int64_t i = 0; i < 300; ++i) {
    const Case c = AnyCase(i);
    models::MinimalRisk manoeuvre(c.limits, c.step_s);
    manoeuvre.Begin(0);
    double last = 0;
    for (std::uint32_t k = 0; k < 200; ++k) {
      const double speed_mps = std::max(0.5, 20 * random.Uniform2(i, k)[0]);
      const double command = manoeuvre.Step(speed_mps);
      ASSERT_LE(std::abs(command - last), c.limits.jerk_mps3 * c.step_s + kRounding);
      ASSERT_GE(command, -c.limits.deceleration_mps2 - kRounding);
      ASSERT_LE(command, 0);
      last = command;
    }
  }
}

}  // namespace
}  // namespace fogline
