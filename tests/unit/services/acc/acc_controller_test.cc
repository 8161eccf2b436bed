#include "services/acc/acc_controller.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/input_errors.h"
#include "tests/unit/services/acc/two_cars.h"

namespace fogline {
namespace {

using Solver = acc::AccController::Solver;

// With the default AccSection, a car at 20 m/s has a safe distance of 33 m.
constexpr double kSpeed = 20;
constexpr double kSafe = 33;

// The final state of a drive of two cars, and the extremes of this drive.
struct Trip {
  TwoCars cars;
  double smallest_gap_m = 1e9;
  double smallest_delta_d_m = 1e9;
  double largest_delta_d_m = -1e9;
  double fastest_mps = 0;
  int fallbacks = 0;
  double largest_control_change = 0;
};

Trip Drive(const AccSection& section, TwoCars cars, int steps, double preceding_mps2 = 0) {
  acc::AccController acc(section, kStep_s);
  Trip trip{.cars = cars};
  double previous = std::nan("");
  for (int k = 0; k < steps; ++k) {
    const acc::AccController::Output output = acc.Step(trip.cars.Sense());
    if (output.solver == Solver::kFallback) ++trip.fallbacks;
    if (k > 0) {
      const double change = std::abs(output.control - previous);
      trip.largest_control_change = std::max(trip.largest_control_change, change);
    }
    previous = output.control;
    trip.cars.Advance(output.acceleration_mps2, preceding_mps2);
    const double delta_d = trip.cars.gap_m - acc::SafeDistance(section, trip.cars.speed_mps);
    trip.smallest_gap_m = std::min(trip.smallest_gap_m, trip.cars.gap_m);
    trip.smallest_delta_d_m = std::min(trip.smallest_delta_d_m, delta_d);
    trip.largest_delta_d_m = std::max(trip.largest_delta_d_m, delta_d);
    trip.fastest_mps = std::max(trip.fastest_mps, trip.cars.speed_mps);
  }
  return trip;
}

TEST(AccControllerTest, AcceleratesWhenTheGapIsTooLarge) {
  acc::AccController acc(AccSection{}, kStep_s);
  TwoCars cars{.gap_m = kSafe + 5, .preceding_speed_mps = kSpeed, .speed_mps = kSpeed};
  const acc::AccController::Output output = acc.Step(cars.Sense());
  EXPECT_GT(output.acceleration_mps2, 0);
  EXPECT_LT(output.control, 0);  // a positive control decelerates
  const Trip trip = Drive(AccSection{}, cars, 50);
  EXPECT_GT(trip.fastest_mps, kSpeed);
  EXPECT_LT(trip.cars.gap_m, cars.gap_m);
}

TEST(AccControllerTest, DeceleratesWhenTheGapIsTooSmall) {
  acc::AccController acc(AccSection{}, kStep_s);
  const TwoCars cars{.gap_m = kSafe - 5, .preceding_speed_mps = kSpeed, .speed_mps = kSpeed};
  const acc::AccController::Output output = acc.Step(cars.Sense());
  EXPECT_LT(output.acceleration_mps2, 0);
  EXPECT_GT(output.control, 0);
  EXPECT_GT(Drive(AccSection{}, cars, 50).cars.gap_m, cars.gap_m);
}

TEST(AccControllerTest, DoesNothingAtTheSafeDistance) {
  acc::AccController acc(AccSection{}, kStep_s);
  const TwoCars cars{.gap_m = kSafe, .preceding_speed_mps = kSpeed, .speed_mps = kSpeed};
  const acc::AccController::Output output = acc.Step(cars.Sense());
  EXPECT_EQ(output.acceleration_mps2, 0);
  EXPECT_EQ(output.safe_distance_m, kSafe);
  EXPECT_EQ(output.solver, Solver::kUnconstrained);
}

TEST(AccControllerTest, ConvergesToTheSafeDistance) {
  for (const double gap_m : {10.0, 25.0, 40.0, 80.0}) {
    for (const double speed_mps : {14.0, 20.0, 26.0}) {
      const TwoCars cars{.gap_m = gap_m, .preceding_speed_mps = kSpeed, .speed_mps = speed_mps};
      const Trip trip = Drive(AccSection{}, cars, 600);
      EXPECT_NEAR(trip.cars.gap_m, kSafe, 0.01) << gap_m << " m, " << speed_mps << " m/s";
      EXPECT_NEAR(trip.cars.speed_mps, kSpeed, 0.01) << gap_m << " m, " << speed_mps << " m/s";
      EXPECT_EQ(trip.fallbacks, 0);
    }
  }
}

// The gap returns to the safe distance and overshoots it by at most kOvershoot.
TEST(AccControllerTest, HardlyOvershootsTheSafeDistance) {
  constexpr double kOvershoot = 0.05;  // m
  for (const double error_m : {-18.0, -5.0, -0.5}) {
    const Trip trip = Drive(AccSection{}, {kSafe + error_m, kSpeed, kSpeed}, 600);
    EXPECT_LE(trip.largest_delta_d_m, kOvershoot) << error_m;
  }
  for (const double error_m : {0.5, 5.0, 27.0}) {
    const Trip trip = Drive(AccSection{}, {kSafe + error_m, kSpeed, kSpeed}, 600);
    EXPECT_GE(trip.smallest_delta_d_m, -kOvershoot) << error_m;
  }
}

TEST(AccControllerTest, NeverChangesItsControlFasterThanAllowed) {
  const AccSection section;
  const double largest = section.max_jerk_mps3 * kStep_s / section.engine_gain;
  for (const double gap_m : {5.0, 15.0, 100.0}) {
    const Trip trip = Drive(section, {gap_m, kSpeed, kSpeed}, 300);
    EXPECT_LE(trip.largest_control_change, largest + 1e-9) << gap_m;
    EXPECT_GT(trip.largest_control_change, 0.5 * largest) << gap_m << ": this one asks for little";
  }
}

TEST(AccControllerTest, StopsBehindACarThatBrakesToAStandstill) {
  const AccSection section;
  const Trip trip = Drive(section, {kSafe, kSpeed, kSpeed}, 600, -3);
  EXPECT_GE(trip.smallest_gap_m, section.min_gap_m);
  EXPECT_NEAR(trip.cars.speed_mps, 0, 0.01);
  EXPECT_NEAR(trip.cars.gap_m, section.standstill_m, 0.01);
  EXPECT_EQ(trip.fallbacks, 0);
}

TEST(AccControllerTest, TheMinimumGapOverrulesTheSafeDistance) {
  // GIVEN a safe distance of 8 m at 12 m/s, but a minimum gap of 10 m
  AccSection section;
  section.headway_s = 0.5;
  section.standstill_m = 2;
  section.min_gap_m = 10;
  for (const double gap_m : {6.0, 8.0, 15.0}) {
    const Trip trip = Drive(section, {gap_m, 12, 12}, 300);
    // THEN the gap ends at the minimum gap, within some centimetres because this limit is soft
    EXPECT_NEAR(trip.cars.gap_m, section.min_gap_m, 0.05) << gap_m;
    EXPECT_NEAR(trip.cars.speed_mps, 12, 1e-3) << gap_m;
    EXPECT_GE(trip.smallest_gap_m, std::min(gap_m, section.min_gap_m) - 0.05) << gap_m;
  }
}

TEST(AccControllerTest, HoldsTheBrakeAtAStandstillTooCloseToTheNextCar) {
  const AccSection section;
  acc::AccController acc(section, kStep_s);
  const TwoCars cars{.gap_m = 1, .preceding_speed_mps = 0, .speed_mps = 0};
  for (int k = 0; k < 20; ++k) EXPECT_LE(acc.Step(cars.Sense()).acceleration_mps2, 0);
}

TEST(AccControllerTest, ApproachesItsMaximumSpeedFromBelow) {
  const AccSection section;
  const Trip trip = Drive(section, {200, 45, 30}, 600);
  // The plan keeps the limit exactly. In the plan, the acceleration approaches the command
  // gradually. The car of this test has the commanded acceleration from the beginning of the step.
  // So its speed may differ a little from the plan.
  EXPECT_LE(trip.fastest_mps, section.max_speed_mps + 1e-3);
  EXPECT_NEAR(trip.cars.speed_mps, section.max_speed_mps, 1e-3);
  EXPECT_EQ(trip.fallbacks, 0);
}

TEST(AccControllerTest, BringsACarThatIsTooFastBackToItsMaximumSpeed) {
  const AccSection section;
  // GIVEN a driver who leaves the car 4 m/s too fast and still accelerating
  const Trip trip = Drive(section, {200, 45, 44, 1.0}, 100);
  // THEN the automation brakes back to the limit without a fallback
  EXPECT_LE(trip.cars.speed_mps, section.max_speed_mps + 1e-3);
  EXPECT_EQ(trip.fallbacks, 0);
}

TEST(AccControllerTest, BrakesAtTheFallbackDecelerationWithoutATarget) {
  const AccSection section;
  acc::AccController acc(section, kStep_s);
  TwoCars cars{.gap_m = kSafe, .preceding_speed_mps = kSpeed, .speed_mps = kSpeed};
  for (int k = 0; k < 40; ++k) {
    acc::AccController::Input input = cars.Sense();
    input.has_target = false;
    const acc::AccController::Output output = acc.Step(input);
    EXPECT_EQ(output.solver, Solver::kFallback);
    EXPECT_EQ(output.safe_distance_m, acc::SafeDistance(section, cars.speed_mps));
    EXPECT_GE(output.acceleration_mps2 - cars.acceleration_mps2, -section.max_jerk_mps3 * kStep_s);
    cars.Advance(output.acceleration_mps2);
  }
  // Because of the engine's lag, about e^-7 of the change is still missing.
  EXPECT_NEAR(cars.acceleration_mps2, -section.fallback_deceleration_mps2, 1e-3);
}

TEST(AccControllerTest, IgnoresDistanceAndSpeedOfAMissingTarget) {
  acc::AccController one(AccSection{}, kStep_s);
  acc::AccController other(AccSection{}, kStep_s);
  const acc::AccController::Input input{.distance_m = 0,
                                        .relative_speed_mps = 0,
                                        .speed_mps = kSpeed,
                                        .acceleration_mps2 = 0,
                                        .has_target = false};
  acc::AccController::Input far = input;
  far.distance_m = 100;
  far.relative_speed_mps = 5;
  EXPECT_EQ(one.Step(input).acceleration_mps2, other.Step(far).acceleration_mps2);
}

TEST(AccControllerTest, FallsBackAtTheIterationLimit) {
  AccSection section;
  section.max_iterations = 1;
  acc::AccController acc(section, kStep_s);
  // GIVEN a situation for which one iteration is too few: hard braking reaches many limits
  const acc::AccController::Output output = acc.Step({.distance_m = 10,
                                                      .relative_speed_mps = -10,
                                                      .speed_mps = kSpeed,
                                                      .acceleration_mps2 = 0,
                                                      .has_target = true});
  // THEN the command is the first step of the fall-back plan
  EXPECT_EQ(output.solver, Solver::kFallback);
  EXPECT_EQ(output.iterations, 1);
  EXPECT_EQ(output.control, section.max_jerk_mps3 * kStep_s / section.engine_gain);
}

// When the automation takes over from a driver, the car may have any acceleration a. If the control
// u does not change, the car finally has the acceleration a_u = -K_e u (K_e is engine_gain). In a
// step of h, the acceleration of the ACC's model goes the share 1 - e^(-h/T_e) of the way from a to
// a_u (T_e is engine_time_constant_s). The difference between a_u and a is at most h max_jerk_mps3,
// plus the amount by which a is outside of the automation's limits.
TEST(AccControllerTest, TakesOverWithoutABump) {
  const AccSection section;
  const double share = -std::expm1(-kStep_s / section.engine_time_constant_s);
  for (double a = -8; a <= 5; a += 0.25) {
    for (const double gap_m : {10.0, 33.0, 90.0}) {
      // GIVEN an ACC that had no effect on the car for a while
      acc::AccController acc(section, kStep_s);
      TwoCars cars{.gap_m = gap_m, .preceding_speed_mps = kSpeed, .speed_mps = kSpeed};
      for (int k = 0; k < 10; ++k) acc.Step(cars.Sense());
      // WHEN the driver accelerates or brakes
      cars.acceleration_mps2 = a;
      const double offered = acc.Step(cars.Sense()).acceleration_mps2;
      // THEN the automation continues from the car's acceleration a
      const double outside =
          std::abs(a - std::clamp(a, section.min_acceleration_mps2, section.max_acceleration_mps2));
      EXPECT_LE(std::abs(offered - a), share * (section.max_jerk_mps3 * kStep_s + outside) + 1e-9)
          << "a " << a << " gap " << gap_m;
    }
  }
}

TEST(AccControllerTest, CountsItsChangeOfControlFromTheAccelerationThatADriverLeftBehind) {
  AccSection section;
  section.engine_gain = 0.732;
  acc::AccController acc(section, kStep_s);
  TwoCars cars{.gap_m = 100, .preceding_speed_mps = kSpeed, .speed_mps = kSpeed};
  // GIVEN an ACC that wants to accelerate, and a driver who brakes at 1 m/s2
  for (int k = 0; k < 20; ++k) acc.Step(cars.Sense());
  cars.acceleration_mps2 = -1;
  // THEN the control begins at the value that would keep the acceleration of -1 m/s2, and changes
  // at the maximum rate
  const double change = section.max_jerk_mps3 * kStep_s / section.engine_gain;
  EXPECT_NEAR(acc.Step(cars.Sense()).control, 1 / section.engine_gain - change, 1e-9);
}

TEST(AccControllerTest, EqualInputsGiveEqualBits) {
  acc::AccController one(AccSection{}, kStep_s);
  acc::AccController other(AccSection{}, kStep_s);
  TwoCars cars{.gap_m = 15, .preceding_speed_mps = 12, .speed_mps = kSpeed};
  for (int k = 0; k < 300; ++k) {
    const acc::AccController::Output a = one.Step(cars.Sense());
    const acc::AccController::Output b = other.Step(cars.Sense());
    ASSERT_EQ(a.acceleration_mps2, b.acceleration_mps2) << k;
    ASSERT_EQ(a.control, b.control) << k;
    ASSERT_EQ(a.iterations, b.iterations) << k;
    cars.Advance(a.acceleration_mps2, std::sin(0.1 * k));
  }
}

TEST(AccControllerTest, RefusesWeightsThatMakeAnIllConditionedProblem) {
  AccSection section;
  section.horizon_steps = 60;
  section.headway_s = 0;
  section.engine_gain = 10;
  section.weight_distance = 1e6;
  section.weight_speed = 0;
  section.weight_acceleration = 0;
  section.weight_control = 1e-6;
  section.weight_control_change = 0;
  EXPECT_THAT(test::ErrorOf([&] { acc::AccController acc(section, 1.0); }),
              testing::HasSubstr("raise weight_control"));
}

}  // namespace
}  // namespace fogline
