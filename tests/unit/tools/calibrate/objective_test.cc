#include "tools/calibrate/objective.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "tests/support/input_errors.h"
#include "tools/calibrate/calibrate.h"

namespace fogline {
namespace {

bool Always() { return true; }

// A short run in fog with noise, so that the seeds give different results.
calibrate::CalibrationProblem ShortProblem() {
  calibrate::CalibrationProblem problem;
  problem.scenario = ParseScenario(R"({"version": 1, "steps": 120,
    "fog": {"model": "bias", "profile": "half_sine", "start_s": 2, "duration_s": 8, "bias_m": 0.4},
    "radar": {"bias_m": 0.95, "range_std_m": 0.02}, "lidar": {"range_std_m": 0.01}})");
  problem.fields = calibrate::ParseFreeFields({"/fog/bias_m=0.2:0.6"});
  problem.target = {{.threshold = 0.5, .si_pct = 80, .rhe_pct = 1},
                    {.threshold = 0.8, .si_pct = 10, .rhe_pct = 0}};
  problem.seeds = {1, 4};
  return problem;
}

calibrate::Evaluation Evaluate(const calibrate::CalibrationProblem& problem, double value = 0.4) {
  const double values[] = {value};
  return *calibrate::Objective(problem).Evaluate(values, Always);
}

TEST(ObjectiveTest, IsZeroForTheTableThatTheScenarioHas) {
  calibrate::CalibrationProblem problem = ShortProblem();
  problem.spread_weight = 0;
  const calibrate::Evaluation first = Evaluate(problem);
  for (std::size_t i = 0; i < problem.target.size(); ++i) {
    problem.target[i].si_pct = first.rows[i].si_pct.mean();
    problem.target[i].rhe_pct = first.rows[i].rhe_pct.mean();
  }
  EXPECT_EQ(Evaluate(problem).objective, 0);
  EXPECT_GT(Evaluate(problem, 0.5).objective, 0);
}

TEST(ObjectiveTest, IsTheWeightedSumOfSquares) {
  calibrate::CalibrationProblem problem = ShortProblem();
  problem.rhe_weight = 3;
  problem.spread_weight = 0.5;
  const calibrate::Evaluation evaluation = Evaluate(problem);
  double sum = 0;
  for (std::size_t i = 0; i < problem.target.size(); ++i) {
    const calibrate::TableRow& row = evaluation.rows[i];
    const double si = *row.si_pct.mean() - *problem.target[i].si_pct;
    const double rhe = *row.rhe_pct.mean() - *problem.target[i].rhe_pct;
    const double deviation = *row.si_pct.deviation();
    EXPECT_GT(deviation, 0);
    sum += si * si + 3 * rhe * rhe + 0.5 * deviation * deviation;
  }
  EXPECT_DOUBLE_EQ(evaluation.objective, sum);
}

TEST(ObjectiveTest, PassesOverNumbersThatTheTargetDoesNotHave) {
  calibrate::CalibrationProblem problem = ShortProblem();
  problem.spread_weight = 0;
  const double whole = Evaluate(problem).objective;
  calibrate::CalibrationProblem rest = problem;
  problem.target[0].si_pct.reset();
  problem.target[1].rhe_pct.reset();
  rest.target[0].rhe_pct.reset();
  rest.target[1].si_pct.reset();
  EXPECT_NEAR(Evaluate(problem).objective + Evaluate(rest).objective, whole, 1e-9 * whole);
}

TEST(ObjectiveTest, CountsSeedsWithoutCompromisedSafetyAsFarFromTheTarget) {
  // GIVEN a safety floor that is above the shortfall of every gap, so that no seed has an SI
  calibrate::CalibrationProblem problem = ShortProblem();
  problem.scenario.measures.safety_floor_m = 10;
  const calibrate::Evaluation evaluation = Evaluate(problem);
  EXPECT_EQ(evaluation.rows[0].si_pct.count(), 0);
  EXPECT_GE(evaluation.objective, 2 * 1000.0 * 1000.0);
}

TEST(ObjectiveTest, DoesNotDependOnTheNumberOfThreads) {
  calibrate::CalibrationProblem problem = ShortProblem();
  const double one = Evaluate(problem).objective;
  problem.jobs = 3;
  EXPECT_EQ(Evaluate(problem).objective, one);
}

TEST(ObjectiveTest, TellsWhyAScenarioCannotRun) {
  calibrate::CalibrationProblem problem = ShortProblem();
  problem.scenario.step_s = 1;
  AccSection& acc = problem.scenario.acc;
  acc.horizon_steps = 60;
  acc.headway_s = 0;
  acc.engine_gain = 10;
  acc.weight_distance = 1e6;
  acc.weight_speed = 0;
  acc.weight_acceleration = 0;
  acc.weight_control = 1e-6;
  acc.weight_control_change = 0;
  EXPECT_EQ(Evaluate(problem).refusal,
            "scenario: error: ACC: the weights make an ill-conditioned problem; raise "
            "weight_control or lower the other weights or horizon_steps (at "
            "/arbitrator/threshold=0.5, seed 1) with /fog/bias_m=0.4");
  EXPECT_THROW(calibrate::Calibrate(calibrate::Objective(problem), 5, Always, [](int, double) {}),
               InputError);
}

TEST(ObjectiveTest, StopsWhenAsked) {
  const double values[] = {0.4};
  EXPECT_FALSE(calibrate::Objective(ShortProblem()).Evaluate(values, [] { return false; }));
}

TEST(ObjectiveTest, NeedsAPolicyWithAThreshold) {
  calibrate::CalibrationProblem problem = ShortProblem();
  problem.scenario.arbitrator.policy = Policy::kNone;
  EXPECT_EQ(test::ErrorOf([&] { const calibrate::Objective objective(problem); }),
            "scenario: error: /arbitrator/policy is none, which uses no threshold; these policies "
            "do: traded, adaptive, availability, traded_isolating");
}

TEST(CalibrateTest, IsNeverWorseThanTheStart) {
  const calibrate::Objective objective(ShortProblem());
  const auto found = calibrate::Calibrate(objective, 10, Always, [](int, double) {});
  ASSERT_TRUE(found && found->objective_at_start);
  EXPECT_LE(found->best.objective, *found->objective_at_start);
  EXPECT_EQ(*found->objective_at_start, Evaluate(ShortProblem()).objective);
  EXPECT_EQ(found->evaluations, 10);
  EXPECT_EQ(objective.Evaluate(found->values, Always)->objective, found->best.objective);
}

TEST(CalibrateTest, ReportsOnlyProgress) {
  double last = std::numeric_limits<double>::infinity();
  int evaluations = 0;
  calibrate::Calibrate(calibrate::Objective(ShortProblem()), 10, Always,
                       [&](int done, double best) {
                         EXPECT_EQ(done, evaluations + 1);
                         EXPECT_LE(best, last);
                         evaluations = done;
                         last = best;
                       });
  EXPECT_EQ(evaluations, 10);
}

TEST(CalibrateTest, KeepsTheBestWhenStopped) {
  int evaluations = 0;
  const auto found = calibrate::Calibrate(
      calibrate::Objective(ShortProblem()), 1000, [&] { return evaluations < 3; },
      [&](int done, double) { evaluations = done; });
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->interrupted);
  EXPECT_EQ(found->evaluations, 3);
  EXPECT_EQ(found->values.size(), 1U);
}

TEST(CalibrateTest, HasNothingWhenStoppedBeforeTheFirstTable) {
  EXPECT_FALSE(calibrate::Calibrate(
      calibrate::Objective(ShortProblem()), 10, [] { return false; }, [](int, double) {}));
}

TEST(SensitivityTest, IsTheSlopeOfTheTable) {
  // GIVEN the tables for fog biases of 0.398 m and 0.402 m. These two values are 1 % of the range
  // apart.
  const calibrate::CalibrationProblem problem = ShortProblem();
  const calibrate::Evaluation below = Evaluate(problem, 0.398);
  const calibrate::Evaluation above = Evaluate(problem, 0.402);
  const auto changes = calibrate::Sensitivities(calibrate::Objective(problem), {0.4}, Always);
  ASSERT_TRUE(changes);
  for (std::size_t row = 0; row < 2; ++row) {
    // THEN the reported change for 1 % of the range is the difference of the two tables. The
    // tolerance is for the rounding of the two values to 1e-6 m: they are 4e-3 m apart.
    const double slope = *above.rows[row].si_pct.mean() - *below.rows[row].si_pct.mean();
    EXPECT_NE(slope, 0);
    EXPECT_NEAR(*(*changes)[0][row].si_pct, slope, 1e-3 * std::abs(slope));
  }
}

TEST(SensitivityTest, LooksToOneSideAtABoundAndAWholeStepForAnInteger) {
  calibrate::CalibrationProblem problem = ShortProblem();
  problem.fields = calibrate::ParseFreeFields({"/arbitrator/window_steps=8:16"});
  const calibrate::Evaluation here = Evaluate(problem, 8);
  const calibrate::Evaluation next = Evaluate(problem, 9);
  const auto changes = calibrate::Sensitivities(calibrate::Objective(problem), {8}, Always);
  ASSERT_TRUE(changes);
  // The field has the range 8 to 16. So one step is an eighth of the range, 12.5 %.
  EXPECT_NEAR(*(*changes)[0][0].si_pct,
              (*next.rows[0].si_pct.mean() - *here.rows[0].si_pct.mean()) / 12.5, 1e-9);
}

TEST(SensitivityTest, DoesNotLeaveTheRangeOfAnIntegerAtItsHigherBound) {
  calibrate::CalibrationProblem problem = ShortProblem();
  problem.fields = calibrate::ParseFreeFields({"/arbitrator/window_steps=8:16"});
  const calibrate::Evaluation before = Evaluate(problem, 15);
  const calibrate::Evaluation here = Evaluate(problem, 16);
  const double difference = *here.rows[0].si_pct.mean() - *before.rows[0].si_pct.mean();
  EXPECT_NE(difference, 0);
  EXPECT_NE(*Evaluate(problem, 17).rows[0].si_pct.mean(), *here.rows[0].si_pct.mean());
  const auto changes = calibrate::Sensitivities(calibrate::Objective(problem), {16}, Always);
  ASSERT_TRUE(changes);
  EXPECT_NEAR(*(*changes)[0][0].si_pct, difference / 12.5, 1e-9);
}

}  // namespace
}  // namespace fogline
