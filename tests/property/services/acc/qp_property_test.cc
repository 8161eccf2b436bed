#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "services/acc/qp.h"
#include "tests/property/services/acc/draw.h"
#include "tests/property/services/acc/random_problems.h"

namespace fogline {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Status = acc::QpSolver::Status;

constexpr acc::QpSolver::Options kOptions{.max_iterations = 10'000};

double Largest(const VectorXd& v) { return v.size() > 0 ? v.cwiseAbs().maxCoeff() : 0; }

// Expects the conditions of Karush, Kuhn & Tucker. For a strictly convex program, these conditions
// hold at the minimum and nowhere else. @return the number of active limits
int ExpectMinimum(const QuadraticProgram& program, const acc::QpSolver& solver) {
  const VectorXd& x = solver.solution();
  const VectorXd& y = solver.multipliers();
  const VectorXd slope = program.hessian * x + program.linear;
  const VectorXd pull = program.constraints.transpose() * y;
  // The rounding of the sums is relative to the largest terms of the sums.
  const double scale = 1 + Largest(program.hessian.cwiseAbs() * x.cwiseAbs()) +
                       Largest(program.linear) +
                       Largest(program.constraints.cwiseAbs().transpose() * y.cwiseAbs());
  EXPECT_LE(Largest(slope - pull), 1e-10 * scale);

  const VectorXd value = program.constraints * x;
  int active = 0;
  for (Index row = 0; row < value.size(); ++row) {
    const double tolerance = 1e-9 * (1 + std::abs(value(row)));
    EXPECT_GE(value(row), program.lower(row) - tolerance) << row;
    EXPECT_LE(value(row), program.upper(row) + tolerance) << row;
    if (y(row) == 0) continue;
    ++active;
    EXPECT_NEAR(value(row), y(row) > 0 ? program.lower(row) : program.upper(row), tolerance) << row;
  }
  return active;
}

TEST(QpPropertyTest, RandomProgramsAreSolvedToTheirMinimum) {
  Draw draw(1);
  int with_active_limits = 0;
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(i);
    const QuadraticProgram program = RandomProgram(draw);
    acc::QpSolver solver(program.hessian, program.constraints, kOptions);
    ASSERT_EQ(solver.Solve(program.linear, program.lower, program.upper).status, Status::kOptimal);
    if (ExpectMinimum(program, solver) > 0) ++with_active_limits;
    if (HasFailure()) return;
  }
  EXPECT_GT(with_active_limits, 1500);
}

// One solver solves all situations of an AccSection. It starts each situation from the solution of
// the previous situation, so most starting points are far from the minimum.
TEST(QpPropertyTest, ProgramsOfTheAccAreSolvedToTheirMinimum) {
  Draw draw(2);
  int with_active_limits = 0;
  for (int i = 0; i < 100; ++i) {
    const acc::AccProgram acc(RandomSection(draw), RandomStep(draw));
    acc::QpSolver solver(acc.hessian(), acc.constraints(), kOptions);
    for (int k = 0; k < 20; ++k) {
      SCOPED_TRACE(testing::Message() << "section " << i << " situation " << k);
      const QuadraticProgram program = ProgramOf(acc, RandomSituation(draw, acc));
      ASSERT_EQ(solver.Solve(program.linear, program.lower, program.upper).status,
                Status::kOptimal);
      if (ExpectMinimum(program, solver) > 0) ++with_active_limits;
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(with_active_limits, 1500);
}

TEST(QpPropertyTest, TheMinimumDoesNotDependOnTheStart) {
  Draw draw(3);
  for (int i = 0; i < 100; ++i) {
    const acc::AccProgram acc(RandomSection(draw), RandomStep(draw));
    acc::QpSolver warm(acc.hessian(), acc.constraints(), kOptions);
    for (int k = 0; k < 5; ++k) {
      const QuadraticProgram program = ProgramOf(acc, RandomSituation(draw, acc));
      acc::QpSolver cold(acc.hessian(), acc.constraints(), kOptions);
      warm.Solve(program.linear, program.lower, program.upper);
      cold.Solve(program.linear, program.lower, program.upper);
      EXPECT_LE(Largest(warm.solution() - cold.solution()), 1e-8 * (1 + Largest(cold.solution())))
          << "section " << i << " situation " << k;
    }
  }
}

// The test adds a row that is a combination of two other rows. The limit of the new row contradicts
// the limits of the two rows (Farkas' lemma).
TEST(QpPropertyTest, ContradictionsAreFound) {
  Draw draw(4);
  for (int i = 0; i < 1000; ++i) {
    QuadraticProgram program = RandomProgram(draw);
    const Index n = program.hessian.rows();
    const Index m = program.constraints.rows();
    // GIVEN a new row c, the sum of two rows c_r with weights w_r > 0: each feasible x has c'x <=
    // sum w_r upper_r
    const Index row = draw.Integer(0, m - 1);
    const Index other = draw.Integer(0, m - 1);
    const double weight = draw.Uniform(0.1, 2);
    for (const Index r : {row, other}) {
      if (std::isinf(program.upper(r))) program.upper(r) = std::max(program.lower(r), 0.0) + 1;
    }
    program.constraints.conservativeResize(m + 1, n);
    program.lower.conservativeResize(m + 1);
    program.upper.conservativeResize(m + 1);
    program.constraints.row(m) =
        program.constraints.row(row) + weight * program.constraints.row(other);
    // WHEN c'x must be greater than sum w_r upper_r
    program.lower(m) =
        program.upper(row) + weight * program.upper(other) + draw.LogUniform(1e-6, 1);
    program.upper(m) = std::numeric_limits<double>::infinity();
    // THEN the program has no solution
    acc::QpSolver solver(program.hessian, program.constraints, kOptions);
    EXPECT_EQ(solver.Solve(program.linear, program.lower, program.upper).status,
              Status::kInfeasible)
        << i;
  }
}

}  // namespace
}  // namespace fogline
