#include "services/acc/qp.h"

#include <cmath>
#include <initializer_list>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace fogline {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

VectorXd Vector(std::initializer_list<double> values) {
  VectorXd v(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double value : values) v(i++) = value;
  return v;
}

// The solver minimises 1/2 |x - p|^2, half of the squared distance from the point p = (3, 2) in the
// plane. So every optimum is obvious.
class PlaneTest : public testing::Test {
 protected:
  acc::QpSolver::Result Solve(const MatrixXd& constraints, const VectorXd& lower,
                              const VectorXd& upper, std::int64_t max_iterations = 100) {
    acc::QpSolver solver(MatrixXd::Identity(2, 2), constraints, {.max_iterations = max_iterations});
    const acc::QpSolver::Result result = solver.Solve(-point_, lower, upper);
    x_ = solver.solution();
    y_ = solver.multipliers();
    return result;
  }

  const VectorXd point_ = Vector({3, 2});
  VectorXd x_;
  VectorXd y_;
};

using Status = acc::QpSolver::Status;

TEST_F(PlaneTest, FindsTheUnconstrainedMinimumWithoutAnIteration) {
  const auto result = Solve(MatrixXd::Identity(2, 2), Vector({-9, -9}), Vector({9, 9}));
  EXPECT_EQ(result.status, Status::kOptimal);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_TRUE(x_.isApprox(point_, 1e-15));
  EXPECT_TRUE(y_.isZero(0));
}

TEST_F(PlaneTest, ProjectsOntoABox) {
  const auto result = Solve(MatrixXd::Identity(2, 2), Vector({0, 5}), Vector({1, 9}));
  EXPECT_EQ(result.status, Status::kOptimal);
  EXPECT_TRUE(x_.isApprox(Vector({1, 5}), 1e-15));
  // A multiplier is negative at an upper limit, and positive at a lower limit.
  EXPECT_TRUE(y_.isApprox(Vector({-2, 3}), 1e-15));
}

TEST_F(PlaneTest, ProjectsOntoALine) {
  const MatrixXd sum = MatrixXd::Ones(1, 2);
  const auto result = Solve(sum, Vector({1}), Vector({1}));
  EXPECT_EQ(result.status, Status::kOptimal);
  EXPECT_TRUE(x_.isApprox(Vector({1, 0}), 1e-15));
}

TEST_F(PlaneTest, DropsALimitThatIsNoLongerActiveAtTheOptimum) {
  // Of the three limits, the point violates x + 100 y <= 50 most. But at the optimum only x <= 0
  // and y <= 0.1 are active.
  const MatrixXd constraints{{1, 100}, {1, 0}, {0, 1}};
  const auto result =
      Solve(constraints, Vector({-kInfinity, -kInfinity, -kInfinity}), Vector({50, 0, 0.1}));
  EXPECT_EQ(result.status, Status::kOptimal);
  EXPECT_TRUE(x_.isApprox(Vector({0, 0.1}), 1e-14));
  EXPECT_EQ(y_(0), 0);
  EXPECT_GE(result.iterations, 4);  // three limits added, one dropped
}

TEST_F(PlaneTest, ToleratesLimitsThatRepeatEachOther) {
  const MatrixXd constraints{{1, 0}, {1, 0}, {2, 0}, {0, 1}};
  const auto result = Solve(constraints, Vector({-9, -9, -9, -9}), Vector({1, 1, 2, 9}));
  EXPECT_EQ(result.status, Status::kOptimal);
  EXPECT_TRUE(x_.isApprox(Vector({1, 2}), 1e-15));
}

TEST_F(PlaneTest, ToleratesMoreActiveLimitsThanVariables) {
  // Five lines through the origin. At the origin all of them are active.
  const MatrixXd constraints{{1, 0}, {0, 1}, {1, 1}, {1, 2}, {2, 1}};
  const auto result = Solve(constraints, VectorXd::Constant(5, -9), VectorXd::Zero(5));
  EXPECT_EQ(result.status, Status::kOptimal);
  EXPECT_LE(x_.norm(), 1e-14);
  EXPECT_LE((x_ - point_ - constraints.transpose() * y_).norm(), 1e-13);
}

TEST_F(PlaneTest, ReportsContradictoryLimits) {
  const MatrixXd constraints{{1, 0}, {0, 1}, {1, 1}};
  // x <= 1 and y <= 1, but x + y >= 3
  const auto result =
      Solve(constraints, Vector({-kInfinity, -kInfinity, 3}), Vector({1, 1, kInfinity}));
  EXPECT_EQ(result.status, Status::kInfeasible);
}

TEST_F(PlaneTest, ReportsALowerLimitAboveTheUpperOne) {
  const auto result = Solve(MatrixXd::Identity(2, 2), Vector({1, -9}), Vector({0.5, 9}));
  EXPECT_EQ(result.status, Status::kInfeasible);
}

TEST_F(PlaneTest, GivesUpAtTheIterationLimit) {
  const auto result = Solve(MatrixXd::Identity(2, 2), Vector({0, 5}), Vector({1, 9}), 1);
  EXPECT_EQ(result.status, Status::kIterationLimit);
  EXPECT_EQ(result.iterations, 1);
}

TEST(QpSolverTest, FindsTheSameMinimumFromAnyActiveSet) {
  const MatrixXd hessian{{4, 1, 0}, {1, 3, 1}, {0, 1, 2}};
  const MatrixXd constraints{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, -1, 1}};
  const VectorXd lower = VectorXd::Constant(4, -1);
  const VectorXd upper = VectorXd::Constant(4, 1);
  acc::QpSolver warm(hessian, constraints, {});
  for (int i = 0; i < 40; ++i) {
    // GIVEN a linear term that rotates, so that every limit becomes active and inactive again
    const VectorXd linear = 10 * Vector({std::cos(0.3 * i), std::sin(0.5 * i), std::cos(0.7 * i)});
    acc::QpSolver cold(hessian, constraints, {});
    // WHEN one solver has solved the earlier problems and the other solver has not
    ASSERT_EQ(warm.Solve(linear, lower, upper).status, Status::kOptimal);
    ASSERT_EQ(cold.Solve(linear, lower, upper).status, Status::kOptimal);
    // THEN both solvers agree
    EXPECT_LE((warm.solution() - cold.solution()).norm(), 1e-13) << i;
  }
}

TEST(QpSolverTest, NeedsNoIterationForTheProblemThatItHasJustSolved) {
  acc::QpSolver solver(MatrixXd::Identity(2, 2), MatrixXd::Identity(2, 2), {});
  const VectorXd linear = Vector({-3, -2});
  const VectorXd lower = Vector({0, 0});
  const VectorXd upper = Vector({1, 1});
  EXPECT_EQ(solver.Solve(linear, lower, upper).iterations, 2);
  EXPECT_EQ(solver.Solve(linear, lower, upper).iterations, 0);
  EXPECT_TRUE(solver.solution().isApprox(Vector({1, 1}), 1e-15));
}

TEST(QpSolverTest, ForgetsALimitThatHasBecomeInfinite) {
  acc::QpSolver solver(MatrixXd::Identity(2, 2), MatrixXd::Identity(2, 2), {});
  const VectorXd linear = Vector({-3, -2});
  solver.Solve(linear, Vector({0, 0}), Vector({1, 1}));
  const auto result = solver.Solve(linear, Vector({0, 0}), Vector({kInfinity, 1}));
  EXPECT_EQ(result.status, Status::kOptimal);
  EXPECT_TRUE(solver.solution().isApprox(Vector({3, 1}), 1e-15));
}

TEST(QpSolverTest, GoesOnFromTheOtherLimitsWhenOneHasBecomeInfinite) {
  // GIVEN x <= 1 and y - x <= 1, both active for the point (3, 5)
  const MatrixXd constraints{{1, 0}, {-1, 1}};
  acc::QpSolver solver(MatrixXd::Identity(2, 2), constraints, {});
  const VectorXd linear = Vector({-3, -5});
  const VectorXd lower = Vector({-kInfinity, -kInfinity});
  ASSERT_EQ(solver.Solve(linear, lower, Vector({1, 1})).iterations, 2);
  ASSERT_TRUE(solver.solution().isApprox(Vector({1, 2}), 1e-15));
  // WHEN the second limit becomes infinite
  const auto result = solver.Solve(linear, lower, Vector({1, kInfinity}));
  // THEN the first limit is active from the start
  EXPECT_EQ(result.iterations, 0);
  EXPECT_TRUE(solver.solution().isApprox(Vector({1, 5}), 1e-15));
}

TEST(QpSolverTest, SolvesAFeasibleProblemAfterAnInfeasibleOne) {
  acc::QpSolver solver(MatrixXd::Identity(2, 2), MatrixXd::Identity(2, 2), {});
  const VectorXd linear = Vector({-3, -2});
  ASSERT_EQ(solver.Solve(linear, Vector({1, 0}), Vector({0, 1})).status, Status::kInfeasible);
  ASSERT_EQ(solver.Solve(linear, Vector({0, 0}), Vector({1, 1})).status, Status::kOptimal);
  EXPECT_TRUE(solver.solution().isApprox(Vector({1, 1}), 1e-15));
}

TEST(QpSolverTest, RefusesAHessianWithoutCurvature) {
  const MatrixXd constraints = MatrixXd::Identity(2, 2);
  const MatrixXd flat{{1, 1}, {1, 1}};
  const MatrixXd saddle{{1, 0}, {0, -1}};
  EXPECT_THROW(acc::QpSolver(flat, constraints, {}), std::domain_error);
  EXPECT_THROW(acc::QpSolver(saddle, constraints, {}), std::domain_error);
}

TEST(QpSolverTest, SolvesWithTheHessianAlone) {
  const MatrixXd hessian{{4, 1}, {1, 3}};
  const acc::QpSolver solver(hessian, MatrixXd::Identity(2, 2), {});
  const MatrixXd columns{{1, 2}, {3, 4}};
  EXPECT_TRUE((hessian * solver.SolveHessian(columns)).isApprox(columns, 1e-14));
}

}  // namespace
}  // namespace fogline
