// Random quadratic programs, and random situations of the ACC.
#pragma once

#include <limits>

#include <Eigen/Core>
#include <Eigen/QR>

#include "scenario/sections/control.h"
#include "services/acc/acc_program.h"
#include "tests/property/services/acc/draw.h"

namespace fogline {

/// The quadratic program: minimise 1/2 x'Hx + g'x subject to lower <= C x <= upper.
struct QuadraticProgram {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd linear;
  Eigen::MatrixXd constraints;
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;

  double Cost(const Eigen::VectorXd& x) const { return 0.5 * x.dot(hessian * x) + linear.dot(x); }
};

/// Draws a program that has a feasible point. The program has up to 20 variables, and up to three
/// rows for each variable. Some rows are one-sided, equalities, or multiples of other rows. The
/// unconstrained minimum is usually outside of the limits. The condition number of H is at most
/// 1e4.
inline QuadraticProgram RandomProgram(Draw& draw) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Eigen::Index n = draw.Integer(1, 20);
  const Eigen::Index m = draw.Integer(1, 3 * n);
  QuadraticProgram program;
  const Eigen::MatrixXd basis = draw.Matrix(n, n).householderQr().householderQ();
  Eigen::VectorXd curvature(n);
  for (double& value : curvature) value = draw.LogUniform(0.01, 100);
  program.hessian = basis * curvature.asDiagonal() * basis.transpose();
  program.hessian = (0.5 * (program.hessian + program.hessian.transpose())).eval();

  program.constraints = draw.Matrix(m, n);
  const Eigen::VectorXd inside = draw.Vector(n);
  program.lower.resize(m);
  program.upper.resize(m);
  for (Eigen::Index row = 0; row < m; ++row) {
    if (row > 0 && draw.Chance(0.1)) {
      program.constraints.row(row) =
          draw.Uniform(0.5, 2) * program.constraints.row(draw.Integer(0, row - 1));
    }
    const double value = program.constraints.row(row).dot(inside);
    const bool equality = row < n / 4 && draw.Chance(0.3);
    program.lower(row) = value - (equality ? 0 : draw.Uniform(0, 1));
    program.upper(row) = value + (equality ? 0 : draw.Uniform(0, 1));
    if (!equality && draw.Chance(0.3)) {
      (draw.Chance(0.5) ? program.lower(row) = -kInfinity : program.upper(row) = kInfinity);
    }
  }
  program.linear = -program.hessian * (inside + draw.LogUniform(0.1, 10) * draw.Vector(n));
  return program;
}

/// Random parameters of the ACC, from the whole range that a person might choose.
inline AccSection RandomSection(Draw& draw) {
  AccSection section;
  section.headway_s = draw.Uniform(0.3, 3);
  section.standstill_m = draw.Uniform(0, 10);
  section.engine_time_constant_s = draw.LogUniform(0.05, 2);
  section.engine_gain = draw.LogUniform(0.3, 3);
  section.horizon_steps = draw.Integer(1, 60);
  section.weight_distance = draw.LogUniform(0.01, 100);
  section.weight_speed = draw.LogUniform(0.01, 100);
  section.weight_acceleration = draw.LogUniform(0.001, 10);
  section.weight_control = draw.LogUniform(0.01, 100);
  section.weight_control_change = draw.LogUniform(0.01, 100);
  section.min_acceleration_mps2 = draw.Uniform(-8, -1);
  section.max_acceleration_mps2 = draw.Uniform(0.5, 4);
  section.max_jerk_mps3 = draw.LogUniform(0.5, 50);
  section.max_speed_mps = draw.Uniform(10, 50);
  section.min_gap_m = draw.Uniform(0, 10);
  section.min_gap_weight = draw.LogUniform(1, 1e4);
  section.max_iterations = 10'000;
  section.fallback_deceleration_mps2 = draw.Uniform(0, 8);
  return section;
}

inline double RandomStep(Draw& draw) { return draw.LogUniform(0.02, 0.5); }

/// A random situation, from steady following to a collision that no braking can avoid. The speed
/// may be above the section's maximum.
inline acc::AccSituation RandomSituation(Draw& draw, const acc::AccProgram& program) {
  acc::AccSituation now;
  const double scale = draw.LogUniform(0.01, 1);
  now.state = {scale * draw.Uniform(-50, 50), scale * draw.Uniform(-15, 15),
               scale * draw.Uniform(-8, 5)};
  now.speed_mps = draw.Uniform(0, 55);
  now.previous_control = draw.Uniform(program.MinControl(), program.MaxControl());
  return now;
}

inline QuadraticProgram ProgramOf(const acc::AccProgram& program, const acc::AccSituation& now) {
  const Eigen::Vector4d parameters(now.state(0), now.state(1), now.state(2), now.previous_control);
  const Eigen::Index rows = program.constraints().rows();
  QuadraticProgram result{.hessian = program.hessian(),
                          .linear = program.gradient() * parameters,
                          .constraints = program.constraints(),
                          .lower = Eigen::VectorXd(rows),
                          .upper = Eigen::VectorXd(rows)};
  program.Limits(now, result.lower, result.upper);
  return result;
}

}  // namespace fogline
