// Writes random quadratic programs and this project's solutions to standard output, for
// qp_against_cvxopt.py: 500 of any kind and 500 of the ACC, all with active limits. Each is a row
// of doubles of this machine: n, m, H (n x n), g (n), C (m x n), lower (m), upper (m), x (n);
// matrices column by column.
#include <cstdio>

#include "services/acc/qp.h"
#include "tests/property/acc/draw.h"
#include "tests/property/acc/random_problems.h"

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

// Writes the program and its solution if that has active limits.
bool SolveAndWrite(QpSolver& solver, const QuadraticProgram& program) {
  const QpSolver::Result result = solver.Solve(program.linear, program.lower, program.upper);
  // An unsolved program is written, too: its comparison fails.
  if (result.status == QpSolver::Status::kOptimal && solver.multipliers().isZero(0)) return false;
  Write(program, solver.solution());
  return true;
}

// Whether the set of feasible plans has an inside, which an interior-point method needs. A car that
// is too fast has to brake along one line, until it is slow enough.
bool HasInterior(const AccSection& section, const AccSituation& now) {
  return now.speed_mps + section.engine_time_constant_s * now.state(kOwnAcceleration) <
         section.max_speed_mps;
}

void WritePrograms() {
  Draw draw(kSeed);
  for (int written = 0; written < kProblemsOfEachKind;) {
    const QuadraticProgram program = RandomProgram(draw);
    QpSolver solver(program.hessian, program.constraints, {});
    if (SolveAndWrite(solver, program)) ++written;
  }
  for (int written = 0; written < kProblemsOfEachKind;) {
    const AccSection section = RandomSection(draw);
    const AccProgram acc(section, RandomStep(draw));
    QpSolver solver(acc.hessian(), acc.constraints(), {});
    for (int k = 0; k < 10 && written < kProblemsOfEachKind; ++k) {
      const AccSituation now = RandomSituation(draw, acc);
      if (HasInterior(section, now) && SolveAndWrite(solver, ProgramOf(acc, now))) ++written;
    }
  }
}

}  // namespace
}  // namespace fogline

int main() { fogline::WritePrograms(); }
