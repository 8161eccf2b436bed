#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "services/acc/acc_controller.h"
#include "tests/property/services/acc/draw.h"
#include "tests/property/services/acc/random_problems.h"
#include "tests/unit/services/acc/two_cars.h"

namespace fogline {
namespace {

using Solver = acc::AccController::Solver;

constexpr double kTolerance = 1e-9;

// A random situation, from steady following to a collision that no braking can avoid. The logarithm
// of the speed is uniform, so low speeds are frequent, too.
acc::AccController::Input RandomInput(Draw& draw, const AccSection& section) {
  const double scale = draw.LogUniform(0.01, 1);
  const double speed = draw.LogUniform(0.5, 55);
  return {.distance_m =
              std::max(0.0, acc::SafeDistance(section, speed) + scale * draw.Uniform(-60, 60)),
          .relative_speed_mps = scale * draw.Uniform(-20, 20),
          .speed_mps = speed,
          .acceleration_mps2 = scale * draw.Uniform(-9, 6),
          .has_target = true};
}

// The control u (services/acc/README.md) that a new controller takes as the control of the previous
// step.
double PreviousControl(const AccSection& section, double acceleration_mps2) {
  return std::clamp(-acceleration_mps2 / section.engine_gain,
                    -section.max_acceleration_mps2 / section.engine_gain,
                    -section.min_acceleration_mps2 / section.engine_gain);
}

// Calls check(section, step_s, input, controller, output) for random situations. `output` is the
// controller's first output for this input.
template <class Check>
void ForRandomSituations(std::int64_t seed, Check&& check) {
  Draw draw(seed);
  for (int i = 0; i < 400; ++i) {
    const AccSection section = RandomSection(draw);
    const double step_s = RandomStep(draw);
    for (int k = 0; k < 5; ++k) {
      SCOPED_TRACE(testing::Message() << "section " << i << " situation " << k);
      acc::AccController acc(section, step_s);
      const acc::AccController::Input input = RandomInput(draw, section);
      const acc::AccController::Output output = acc.Step(input);
      check(section, step_s, input, acc, output);
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(AccControllerPropertyTest, EverySituationHasAnOptimum) {
  int on_limits = 0;
  ForRandomSituations(1, [&](const auto&, double, const auto&, const auto&, const auto& output) {
    ASSERT_NE(output.solver, Solver::kFallback);
    if (output.solver == Solver::kActiveSet) ++on_limits;
  });
  EXPECT_GT(on_limits, 500);
  EXPECT_LT(on_limits, 1900);
}

// The controller computes upper bounds of a plan's controls and of their changes. If these bounds
// prove that the plan keeps the limits, the controller does not run the exact check.
TEST(AccControllerPropertyTest, BoundsAreNeverBelowThePlanAndProveOnlyWhatTheExactCheckFinds) {
  Draw draw(7);
  int proved = 0;
  int within = 0;
  for (int i = 0; i < 200; ++i) {
    const AccSection section = RandomSection(draw);
    const acc::AccProgram program(section, RandomStep(draw));
    const Eigen::Index n = program.horizon();
    const acc::LinearPlan plan(0.1 * draw.Matrix(n, 4));
    for (int k = 0; k < 20; ++k) {
      const double scale = draw.LogUniform(1e-4, 10);
      const acc::AccSituation now{
          .state = scale * draw.Vector(3),
          .speed_mps = draw.LogUniform(0.5, 55),
          .previous_control =
              std::clamp(scale * draw.Uniform(-1, 1), program.MinControl(), program.MaxControl())};
      const Eigen::Vector4d p(now.state(0), now.state(1), now.state(2), now.previous_control);
      Eigen::VectorXd controls;
      plan.Compute(p, controls);
      ASSERT_EQ(plan.First(p), controls(0));
      double change = std::abs(controls(0) - now.previous_control);
      for (Eigen::Index j = 1; j < n; ++j) {
        change = std::max(change, std::abs(controls(j) - controls(j - 1)));
      }
      ASSERT_GE(plan.ControlBound(p), controls.cwiseAbs().maxCoeff() - kTolerance);
      ASSERT_GE(plan.ChangeBound(p), change - kTolerance);
      const bool exact =
          program.IsWithinLimits(now, {controls.data(), static_cast<std::size_t>(controls.size())});
      const bool certain =
          program.IsCertainlyWithinLimits(now, plan.ControlBound(p), plan.ChangeBound(p));
      ASSERT_LE(certain, exact) << "section " << i << " situation " << k;
      proved += certain;
      within += exact;
    }
  }
  EXPECT_GT(proved, 100) << "the bounds must be of use";
  EXPECT_LT(proved, within) << "the exact check must be of use";
}

TEST(AccControllerPropertyTest, PlansKeepTheLimitsOfTheControlAndOfItsChange) {
  ForRandomSituations(2, [](const AccSection& section, double step_s, const auto& input,
                            acc::AccController& acc, const auto& output) {
    const double change = section.max_jerk_mps3 * step_s / section.engine_gain;
    double previous = PreviousControl(section, input.acceleration_mps2);
    for (const double u : acc.plan()) {
      EXPECT_GE(-section.engine_gain * u, section.min_acceleration_mps2 - kTolerance);
      EXPECT_LE(-section.engine_gain * u, section.max_acceleration_mps2 + kTolerance);
      EXPECT_LE(std::abs(u - previous), change + kTolerance);
      previous = u;
    }
    EXPECT_EQ(output.control, acc.plan().front());
  });
}

// The maximum of the present speed and of the settled speeds during the fall-back plan. A settled
// speed is the speed at which the car settles if the control is 0 from then on.
double HighestInFallback(const AccSection& section, double step_s,
                         const acc::AccController::Input& input) {
  const acc::AccProgram program(section, step_s);
  double settled = input.speed_mps + section.engine_time_constant_s * input.acceleration_mps2;
  double highest = std::max(input.speed_mps, settled);
  double control = PreviousControl(section, input.acceleration_mps2);
  for (std::int64_t j = 0; j < section.horizon_steps; ++j) {
    control = program.FallbackControl(control);
    settled -= section.engine_gain * control * step_s;
    highest = std::max(highest, settled);
  }
  return highest;
}

// The test computes speeds by closed-form integrals of the model, at the middle and at the end of
// each step.
TEST(AccControllerPropertyTest, PlansKeepTheMaximumSpeedWhereTheFallbackDoes) {
  int close = 0;
  ForRandomSituations(3, [&](const AccSection& section, double step_s, const auto& input,
                             acc::AccController& acc, const auto&) {
    if (HighestInFallback(section, step_s, input) > section.max_speed_mps) return;
    const double tau = section.engine_time_constant_s;
    double speed = input.speed_mps;
    double acceleration = input.acceleration_mps2;
    for (const double u : acc.plan()) {
      for (int half = 0; half < 2; ++half) {
        const double share = -std::expm1(-step_s / 2 / tau);
        const double steady = -section.engine_gain * u;
        speed += steady * step_s / 2 + (acceleration - steady) * tau * share;
        acceleration += (steady - acceleration) * share;
        EXPECT_LE(speed, section.max_speed_mps + kTolerance);
        if (speed > section.max_speed_mps - 0.1) ++close;
      }
    }
  });
  EXPECT_GT(close, 100) << "the limit must matter";
}

TEST(AccControllerPropertyTest, PlansOfAFasterCarLoseSpeedAsInAFallback) {
  int faster = 0;
  ForRandomSituations(4, [&](const AccSection& section, double step_s, const auto& input,
                             acc::AccController& acc, const auto&) {
    const acc::AccProgram program(section, step_s);
    double settled = input.speed_mps + section.engine_time_constant_s * input.acceleration_mps2;
    if (settled <= section.max_speed_mps) return;
    ++faster;
    double fallback = settled;
    double control = PreviousControl(section, input.acceleration_mps2);
    for (const double u : acc.plan()) {
      control = program.FallbackControl(control);
      fallback -= section.engine_gain * control * step_s;
      settled -= section.engine_gain * u * step_s;
      EXPECT_LE(settled, std::max(section.max_speed_mps, fallback) + kTolerance);
    }
  });
  EXPECT_GT(faster, 100);
}

// The controller uses the plan of the precomputed gain only if this plan also keeps the soft
// limits: the minimum gap, and no reversing.
TEST(AccControllerPropertyTest, UnconstrainedPlansKeepTheMinimumGapAndDoNotReverse) {
  int close = 0;
  ForRandomSituations(5, [&](const AccSection& section, double step_s, const auto& input,
                             acc::AccController& acc, const auto& output) {
    if (output.solver != Solver::kUnconstrained) return;
    const acc::DiscreteAccModel model = acc::Discretise(acc::MakeAccModel(section), step_s);
    const double preceding = input.speed_mps + input.relative_speed_mps;
    Eigen::Vector3d x(input.distance_m - acc::SafeDistance(section, input.speed_mps),
                      input.relative_speed_mps, input.acceleration_mps2);
    for (const double u : acc.plan()) {
      x = model.phi * x + model.gamma * u;
      const double speed = preceding - x(acc::kDeltaV);
      const double gap = x(acc::kDeltaD) + acc::SafeDistance(section, speed);
      EXPECT_GE(gap, section.min_gap_m - kTolerance);
      EXPECT_GE(speed + section.engine_time_constant_s * x(acc::kOwnAcceleration), -kTolerance);
      if (gap < section.min_gap_m + 1) ++close;
    }
  });
  EXPECT_GT(close, 10) << "the limit must matter";
}

TEST(AccControllerPropertyTest, TheCommandGoesOnFromTheRealAcceleration) {
  ForRandomSituations(6, [](const AccSection& section, double step_s, const auto& input,
                            const auto&, const auto& output) {
    const double a = input.acceleration_mps2;
    const double outside =
        std::abs(a - std::clamp(a, section.min_acceleration_mps2, section.max_acceleration_mps2));
    const double share = -std::expm1(-step_s / section.engine_time_constant_s);
    EXPECT_LE(std::abs(output.acceleration_mps2 - a),
              share * (section.max_jerk_mps3 * step_s + outside) + kTolerance);
  });
}

// The leader never brakes harder than the automation may brake.
TEST(AccControllerPropertyTest, NeverHitsALeaderThatBrakesNoHarderThanItself) {
  Draw draw(7);
  const AccSection section;
  for (int i = 0; i < 50; ++i) {
    const double speed = draw.Uniform(5, 35);
    TwoCars cars{.gap_m = acc::SafeDistance(section, speed),
                 .preceding_speed_mps = speed,
                 .speed_mps = speed};
    acc::AccController acc(section, cars.step_s);
    double acceleration = 0;
    for (int k = 0; k < 600; ++k) {
      if (draw.Chance(0.03)) acceleration = draw.Uniform(section.min_acceleration_mps2, 2);
      if (cars.preceding_speed_mps > 38) acceleration = std::min(acceleration, 0.0);
      const acc::AccController::Output output = acc.Step(cars.Sense());
      ASSERT_NE(output.solver, Solver::kFallback) << i << " " << k;
      cars.Advance(output.acceleration_mps2, acceleration);
      ASSERT_GT(cars.gap_m, 0) << "run " << i << " step " << k;
    }
  }
}

}  // namespace
}  // namespace fogline
