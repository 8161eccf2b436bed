#include "services/acc/qp.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Jacobi>

namespace fogline::acc {
namespace {

using Eigen::Index;

// A Hessian with a smaller reciprocal condition number counts as singular, because x would have
// fewer than three correct digits.
constexpr double kMinReciprocalCondition = 1e-13;

// A normal counts as linearly dependent on the active normals if its orthogonal part is at most
// this share of the whole normal. Rounding leaves a share of about 1e-16.
constexpr double kDependent = 1e-11;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t Position(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

QpSolver::QpSolver(const Eigen::MatrixXd& hessian, const Eigen::MatrixXd& constraints,
                   const Options& options)
    : options_(options), rows_(constraints.transpose()) {
  const Index n = hessian.rows();
  const Index m = constraints.rows();
  const Eigen::LLT<Eigen::MatrixXd> factor(hessian);
  if (factor.info() != Eigen::Success || !(factor.rcond() > kMinReciprocalCondition)) {
    throw std::domain_error("the Hessian is not positive definite to working precision");
  }
  inverse_factor_ = factor.matrixL().solve(Eigen::MatrixXd::Identity(n, n));
  spans_.reserve(Position(m));
  for (Index row = 0; row < m; ++row) {
    Index begin = 0;
    Index end = n;
    while (begin < end && rows_(begin, row) == 0) ++begin;
    while (end > begin && rows_(end - 1, row) == 0) --end;
    spans_.push_back({.begin = begin, .size = end - begin});
  }

  set_.assign(Position(n), 0);
  q_.setZero(n, n);
  r_.setZero(n, n);
  for (Eigen::VectorXd* v : {&sides_, &lambda_, &along_, &rest_, &correction_, &dual_direction_,
                             &primal_direction_, &scaled_, &x_}) {
    v->setZero(n);
  }
  multipliers_.setZero(m);
}

Eigen::MatrixXd QpSolver::SolveHessian(const Eigen::MatrixXd& columns) const {
  return inverse_factor_.transpose() * (inverse_factor_ * columns);
}

QpSolver::Result QpSolver::Solve(const Eigen::VectorXd& linear, const Eigen::VectorXd& lower,
                                 const Eigen::VectorXd& upper) {
  StartFromActiveSet(linear, lower, upper);
  Result result;
  while (true) {
    Limit limit = MostViolated(lower, upper);
    if (limit.violation <= 0) break;
    double multiplier = 0;
    StepKind kind = StepKind::kDropped;
    while (kind == StepKind::kDropped) {
      if (result.iterations == options_.max_iterations) {
        result.status = Status::kIterationLimit;
        return result;
      }
      ++result.iterations;
      kind = Step(limit, multiplier);
    }
    if (kind == StepKind::kInfeasible) {
      result.status = Status::kInfeasible;
      return result;
    }
  }
  multipliers_.setZero();
  for (Index i = 0; i < active_; ++i) {
    multipliers_(set_[Position(i)]) += sides_(i) * lambda_(i);
  }
  return result;
}

// This function is step 0 of the method of Goldfarb & Idnani (qp.h). But the function starts from
// the last active set, not from an empty set. The function drops limits that are infinite in this
// call. Then it finds the minimum at which the limits of the set are equalities. While a multiplier
// is negative, the function drops the limit with the smallest multiplier, and computes the minimum
// again. L is the Cholesky factor of the Hessian (qp.h), and y = L'x. Let N = Q R be the normals of
// the limits, b the values of the limits, and y0 the value of y at the unconstrained minimum. Then
// y = y0 + Q t with R't = b - N'y0, and the multipliers are the lambda with R lambda = t.
void QpSolver::StartFromActiveSet(const Eigen::VectorXd& linear, const Eigen::VectorXd& lower,
                                  const Eigen::VectorXd& upper) {
  scaled_.noalias() = inverse_factor_.triangularView<Eigen::Lower>() * -linear;
  x_.noalias() = inverse_factor_.triangularView<Eigen::Lower>().transpose() * scaled_;

  for (Index i = active_ - 1; i >= 0; --i) {
    const Index row = set_[Position(i)];
    if (std::isinf(sides_(i) > 0 ? lower(row) : upper(row))) Drop(i);
  }
  while (active_ > 0) {
    auto t = along_.head(active_);
    auto lambda = lambda_.head(active_);
    const auto r = r_.topLeftCorner(active_, active_);
    for (Index i = 0; i < active_; ++i) {
      const Index row = set_[Position(i)];
      t(i) = sides_(i) > 0 ? lower(row) - Value(row) : Value(row) - upper(row);
    }
    r.transpose().triangularView<Eigen::Lower>().solveInPlace(t);
    lambda = t;
    r.triangularView<Eigen::Upper>().solveInPlace(lambda);
    Index smallest = 0;
    if (lambda.minCoeff(&smallest) >= 0) {
      scaled_.noalias() += q_.leftCols(active_) * t;
      x_.noalias() = inverse_factor_.triangularView<Eigen::Lower>().transpose() * scaled_;
      return;
    }
    Drop(smallest);
  }
}

double QpSolver::Value(Index row) const {
  const Span& span = spans_[Position(row)];
  return rows_.col(row).segment(span.begin, span.size).dot(x_.segment(span.begin, span.size));
}

// Returns the limit that is violated most (step 1 of the method). If no limit is violated by more
// than the tolerance, `violation` is 0.
QpSolver::Limit QpSolver::MostViolated(const Eigen::VectorXd& lower,
                                       const Eigen::VectorXd& upper) const {
  Limit worst{.row = 0, .side = 1, .violation = 0};
  for (Index row = 0; row < rows_.cols(); ++row) {
    if (lower(row) == -kInfinity && upper(row) == kInfinity) continue;
    const double value = Value(row);
    const double below = lower(row) - value;
    const double above = value - upper(row);
    const double violation = below > above ? below : above;
    if (violation > options_.tolerance && violation > worst.violation) {
      worst = {.row = row, .side = below > above ? 1.0 : -1.0, .violation = violation};
    }
  }
  return worst;
}

// Step 2 of the method: a step towards `limit`. The step ends at `limit`, or earlier, where the
// multiplier of an active limit would become negative.
QpSolver::StepKind QpSolver::Step(Limit& limit, double& multiplier) {
  const double norm = SplitNormal(limit);
  auto fall = dual_direction_.head(active_);
  fall = along_.head(active_);
  r_.topLeftCorner(active_, active_).triangularView<Eigen::Upper>().solveInPlace(fall);

  double dual_step = kInfinity;  // step size at which a multiplier becomes zero
  Index blocking = 0;
  for (Index i = 0; i < active_; ++i) {
    if (fall(i) > 0 && lambda_(i) < dual_step * fall(i)) {
      dual_step = lambda_(i) / fall(i);
      blocking = i;
    }
  }
  // Step size at which `limit` is met. It is infinite if the normal of `limit` is linearly
  // dependent on the active normals.
  const double primal_step = norm > 0 ? limit.violation / (norm * norm) : kInfinity;
  const double step = primal_step < dual_step ? primal_step : dual_step;
  if (step == kInfinity) return StepKind::kInfeasible;

  if (norm > 0) {
    primal_direction_.noalias() =
        inverse_factor_.triangularView<Eigen::Lower>().transpose() * rest_;
    x_ += step * primal_direction_;
    limit.violation -= step * (norm * norm);
  }
  lambda_.head(active_) -= step * fall;
  multiplier += step;
  if (primal_step <= dual_step) {
    Add(limit, multiplier, norm);
    return StepKind::kAdded;
  }
  Drop(blocking);
  return StepKind::kDropped;
}

// Splits the limit's normal into Q along_ + rest_. Returns |rest_|, or 0 if rest_ is only rounding.
double QpSolver::SplitNormal(const Limit& limit) {
  const Span& span = spans_[Position(limit.row)];
  const auto q = q_.leftCols(active_);
  auto along = along_.head(active_);
  auto correction = correction_.head(active_);
  rest_.noalias() = inverse_factor_.middleCols(span.begin, span.size) *
                    (limit.side * rows_.col(limit.row).segment(span.begin, span.size));
  const double whole = rest_.norm();
  along.noalias() = q.transpose() * rest_;
  rest_.noalias() -= q * along;
  // The rounding error of the first pass is proportional to the whole normal, and rest_ may be
  // smaller than this error. A second pass is sufficient to remove the error.
  correction.noalias() = q.transpose() * rest_;
  rest_.noalias() -= q * correction;
  along += correction;
  const double norm = rest_.norm();
  return active_ < rest_.size() && norm > kDependent * whole ? norm : 0;
}

void QpSolver::Add(const Limit& limit, double multiplier, double norm) {
  q_.col(active_) = rest_ / norm;
  r_.col(active_).head(active_) = along_.head(active_);
  r_(active_, active_) = norm;
  set_[Position(active_)] = limit.row;
  sides_(active_) = limit.side;
  lambda_(active_) = multiplier;
  ++active_;
}

// Drops an active limit: removes its column from R, and rotates the remaining columns back into a
// triangle.
void QpSolver::Drop(Index position) {
  --active_;
  for (Index i = position; i < active_; ++i) {
    r_.col(i).head(i + 2) = r_.col(i + 1).head(i + 2);
    set_[Position(i)] = set_[Position(i + 1)];
    sides_(i) = sides_(i + 1);
    lambda_(i) = lambda_(i + 1);
  }
  Eigen::JacobiRotation<double> rotation;
  for (Index i = position; i < active_; ++i) {
    rotation.makeGivens(r_(i, i), r_(i + 1, i));
    r_.middleCols(i, active_ - i).applyOnTheLeft(i, i + 1, rotation.adjoint());
    q_.applyOnTheRight(i, i + 1, rotation);
  }
}

}  // namespace fogline::acc
