#include "services/acc/acc_program.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/services/acc/two_cars.h"

namespace fogline {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

AccSection ShortSection() {
  AccSection section;
  section.horizon_steps = 6;
  section.engine_gain = 0.732;
  section.weight_distance = 0.7;
  section.weight_speed = 1.3;
  section.weight_acceleration = 0.2;
  section.weight_control = 0.9;
  section.weight_control_change = 2.1;
  return section;
}

const acc::AccSituation kSituation{
    .state = {1.5, -0.8, 0.4}, .speed_mps = 21, .previous_control = -0.3};

// The cost of the plan z, from a simulation of the plan. acc_program.h defines the cost.
double Cost(const AccSection& section, const acc::AccSituation& now, const VectorXd& z) {
  const acc::DiscreteAccModel model = acc::Discretise(acc::MakeAccModel(section), kStep_s);
  Eigen::Vector3d x = now.state;
  double previous = now.previous_control;
  double cost = section.min_gap_weight * z(0) * z(0);
  for (Index j = 1; j < z.size(); ++j) {
    const double u = z(j);
    x = model.phi * x + model.gamma * u;
    cost += section.weight_distance * x(0) * x(0) + section.weight_speed * x(1) * x(1) +
            section.weight_acceleration * x(2) * x(2) + section.weight_control * u * u +
            section.weight_control_change * (u - previous) * (u - previous);
    previous = u;
  }
  return cost;
}

VectorXd SomePlan(Index size, int number) {
  VectorXd z(size);
  for (Index i = 0; i < size; ++i) z(i) = std::sin(static_cast<double>((i + 1) * (number + 2)));
  return z;
}

TEST(AccProgramTest, CostIsTheSumOverTheHorizon) {
  const AccSection section = ShortSection();
  const acc::AccProgram program(section, kStep_s);
  const Eigen::Vector4d p(kSituation.state(0), kSituation.state(1), kSituation.state(2),
                          kSituation.previous_control);
  const VectorXd linear = program.gradient() * p;
  const double constant = Cost(section, kSituation, VectorXd::Zero(7));
  for (int number = 0; number < 10; ++number) {
    const VectorXd z = SomePlan(7, number);
    const double condensed = 0.5 * z.dot(program.hessian() * z) + linear.dot(z) + constant;
    const double cost = Cost(section, kSituation, z);
    EXPECT_NEAR(condensed, cost, 1e-12 * cost);  // rounding of sums
  }
}

// The test compares the distances to the limits, limit - C z, because these have a physical
// meaning. C is the matrix of the constraints, and z is the plan.
TEST(AccProgramTest, LimitsAreThoseOfThePredictedCar) {
  AccSection section = ShortSection();
  section.max_speed_mps = 21.5;
  section.min_gap_m = 36;
  const acc::AccProgram program(section, kStep_s);
  const VectorXd z = SomePlan(7, 3);
  VectorXd lower(30);
  VectorXd upper(30);
  program.Limits(kSituation, lower, upper);
  const VectorXd below = program.constraints() * z - lower;
  const VectorXd above = upper - program.constraints() * z;

  const acc::DiscreteAccModel model = acc::Discretise(acc::MakeAccModel(section), kStep_s);
  const double preceding_mps = kSituation.speed_mps + kSituation.state(acc::kDeltaV);
  Eigen::Vector3d x = kSituation.state;
  const double max_control_change = section.max_jerk_mps3 * kStep_s / section.engine_gain;
  double previous = kSituation.previous_control;
  for (Index j = 0; j < 6; ++j) {
    const double u = z(1 + j);
    x = model.phi * x + model.gamma * u;
    const double speed = preceding_mps - x(acc::kDeltaV);
    const double settled = speed + section.engine_time_constant_s * x(acc::kOwnAcceleration);
    const double gap = x(acc::kDeltaD) + acc::SafeDistance(section, speed);
    const Index row = 5 * j;
    // The limit of the speed is the maximum speed, because this car stays below it also under the
    // fall-back plan (acc_program.h).
    EXPECT_NEAR(above(row), section.max_speed_mps - settled, 1e-12) << j;
    EXPECT_NEAR(below(row + 1), settled + z(0), 1e-12) << j;
    const double forgiven = z(0) * static_cast<double>(6 - j) / 6;
    EXPECT_NEAR(below(row + 2), gap + forgiven - section.min_gap_m, 1e-12) << j;
    EXPECT_NEAR(below(row + 3), u + section.max_acceleration_mps2 / section.engine_gain, 1e-12);
    EXPECT_NEAR(above(row + 3), -section.min_acceleration_mps2 / section.engine_gain - u, 1e-12);
    EXPECT_NEAR(above(row + 4), max_control_change - (u - previous), 1e-12) << j;
    EXPECT_NEAR(below(row + 4), max_control_change + (u - previous), 1e-12) << j;
    previous = u;
  }
}

TEST(AccProgramTest, LeavesOutLimitsThatNoPlanCanReach) {
  // GIVEN a car at a medium speed, far behind the next car
  const acc::AccProgram program(ShortSection(), kStep_s);
  VectorXd lower(30);
  VectorXd upper(30);
  program.Limits(kSituation, lower, upper);
  // THEN only the limits of the control u and of its change remain, in each of the six steps
  EXPECT_EQ((upper.array() < std::numeric_limits<double>::infinity()).count(), 12);
  EXPECT_EQ((lower.array() > -std::numeric_limits<double>::infinity()).count(), 12);
}

TEST(AccProgramTest, KeepsALimitOfTheGapThatOnlyThePresentAccelerationReaches) {
  // GIVEN a car that accelerates harder than the ACC may. Over the horizon of 0.6 s, its gap
  // shrinks by 0.5 * 0.6^2 m for each m/s2 of the acceleration.
  AccSection section = ShortSection();
  const double shrinks_s2 = 0.5 * 0.6 * 0.6;
  const double present = section.max_acceleration_mps2 + 3;
  const acc::AccSituation now{.state = {0, 0, present},
                              .speed_mps = 21,
                              .previous_control = -section.max_acceleration_mps2};
  const double gap_m = acc::SafeDistance(section, now.speed_mps);
  // WHEN only the present acceleration makes the gap too small
  section.min_gap_m = gap_m - shrinks_s2 * (section.max_acceleration_mps2 + 1.5);
  VectorXd lower(30);
  VectorXd upper(30);
  acc::AccProgram(section, kStep_s).Limits(now, lower, upper);
  // THEN the program has the limit of the gap in each of the six steps
  EXPECT_EQ((lower.array() > -std::numeric_limits<double>::infinity()).count(), 12 + 6);
}

TEST(AccProgramTest, KeepsTheLimitsOfAGapThatIsTooSmallAndOpens) {
  // GIVEN a gap below min_gap_m, behind a car that is 10 m/s faster
  AccSection section = ShortSection();
  const acc::AccSituation now{.state = {0, 10, 0}, .speed_mps = 21, .previous_control = 0};
  section.min_gap_m = acc::SafeDistance(section, now.speed_mps) + 0.5;
  VectorXd lower(30);
  VectorXd upper(30);
  acc::AccProgram(section, kStep_s).Limits(now, lower, upper);
  // THEN the program has the limit of the gap in each of the six steps, although the gap is large
  // enough in the last step
  EXPECT_EQ((lower.array() > -std::numeric_limits<double>::infinity()).count(), 12 + 6);
}

TEST(AccProgramTest, FallbackPlanApproachesItsDecelerationAtTheFastestChange) {
  AccSection section;
  section.engine_gain = 0.5;
  section.fallback_deceleration_mps2 = 1.2;
  section.max_jerk_mps3 = 5;
  const acc::AccProgram program(section, kStep_s);
  double u = -0.5;
  std::vector<double> plan;
  for (int j = 0; j < 5; ++j) plan.push_back(u = program.FallbackControl(u));
  // In a step the control u changes by jerk * step / gain = 5 * 0.1 / 0.5, until u is deceleration
  // / gain = 1.2 / 0.5.
  const std::vector<double> expected{0.5, 1.5, 2.4, 2.4, 2.4};
  for (std::size_t j = 0; j < 5; ++j) EXPECT_NEAR(plan[j], expected[j], 1e-15);
}

TEST(AccProgramTest, FallbackPlanStaysWithinTheStrongestBraking) {
  AccSection section;
  section.fallback_deceleration_mps2 = 9;
  section.min_acceleration_mps2 = -3;
  const acc::AccProgram program(section, kStep_s);
  EXPECT_EQ(program.FallbackControl(3), 3);
}

}  // namespace
}  // namespace fogline
