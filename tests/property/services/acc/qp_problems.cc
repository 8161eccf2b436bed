// Writes random quadratic programs and this project's solutions to standard output, for
// qp_against_cvxopt.py. There are 500 general programs and 500 of the ACC, all with active limits.
// Each program is a row of doubles in this machine's byte order: n, m, H (n x n), g (n), C (m x n),
// lower (m), upper (m), x (n). Matrices are column by column.
#include <cstdio>

#include "services/acc/qp.h"
#include "tests/property/services/acc/draw.h"
#include "tests/property/services/acc/random_problems.h"

namespace fogline {
namespace {

constexpr int kProblemsOfEachKind = 500;
constexpr std::int64_t kSeed = 2024;

template <class Matrix>
void Write(const Matrix& values) {
  std::fwrite(values.data(), sizeof(double), static_cast<std::size_t>(values.size()), stdout);
}

void Write(const QuadraticProgram& program, const Eigen::VectorXd& x) {
  Write(Eigen::Vector2d(static_cast<double>(x.size()), static_cast<double>(program.lower.size())));
  Write(program.hessian);
  Write(program.linear);
  Write(program.constraints);
  Write(program.lower);
  Write(program.upper);
  Write(x);
}

// Writes a program and its solution if the solution has active limits. @return whether it was
// written
bool SolveAndWrite(acc::QpSolver& solver, const QuadraticProgram& program) {
  const acc::QpSolver::Result result = solver.Solve(program.linear, program.lower, program.upper);
  // A program that the solver could not solve is written, too. The comparison with cvxopt then
  // fails.
  if (result.status == acc::QpSolver::Status::kOptimal && solver.multipliers().isZero(0))
    return false;
  Write(program, solver.solution());
  return true;
}

// Whether the set of feasible plans has an interior. An interior-point method needs this interior.
// For a car that is too fast the set has no interior, because the limits fix the braking until the
// car is slow enough.
bool HasInterior(const AccSection& section, const acc::AccSituation& now) {
  return now.speed_mps + section.engine_time_constant_s * now.state(acc::kOwnAcceleration) <
         section.max_speed_mps;
}

void WritePrograms() {
  Draw draw(kSeed);
  for (int written = 0; written < kProblemsOfEachKind;) {
    const QuadraticProgram program = RandomProgram(draw);
    acc::QpSolver solver(program.hessian, program.constraints, {});
    if (SolveAndWrite(solver, program)) ++written;
  }
  for (int written = 0; written < kProblemsOfEachKind;) {
    const AccSection section = RandomSection(draw);
    const acc::AccProgram acc(section, RandomStep(draw));
    acc::QpSolver solver(acc.hessian(), acc.constraints(), {});
    for (int k = 0; k < 10 && written < kProblemsOfEachKind; ++k) {
      const acc::AccSituation now = RandomSituation(draw, acc);
      if (HasInterior(section, now) && SolveAndWrite(solver, ProgramOf(acc, now))) ++written;
    }
  }
}

}  // namespace
}  // namespace fogline

int main() { fogline::WritePrograms(); }
