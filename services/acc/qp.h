// A small dense solver for strictly convex quadratic programs. One object solves many programs that
// differ only in their linear term and limits. The solver is not suitable for programs with many
// hundreds of variables, or for programs that are not strictly convex.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace fogline::acc {

/// The dual active-set method of D. Goldfarb and A. Idnani, "A numerically stable dual method for
/// solving strictly convex quadratic programs", Mathematical Programming 27 (1983) 1-33, for
///
///     min 1/2 x'Hx + g'x   subject to   lower <= C x <= upper
///
/// The method adds violated limits one by one to a set of active limits, and drops active limits
/// that block a step. The method needs no feasible start. It needs few iterations if few limits are
/// active.
///
/// H = L L' is the Cholesky factorisation. The normal of a limit is the column L^-1 c, where c' is
/// the row of C. The active normals are stored as a thin QR factorisation that grows and shrinks by
/// one column (Gram-Schmidt with reorthogonalisation and Givens rotations: J. W. Daniel,
/// W. B. Gragg, L. Kaufman and G. W. Stewart, Mathematics of Computation 30 (1976) 772-795). An
/// iteration costs O(n^2). An iteration uses only the part of a row of C between its outermost
/// nonzeros.
///
/// The factorisations depend only on H and C. So every call except the first call starts from the
/// active set of the previous call. If the problems belong to successive steps, this set is nearly
/// the new active set. The result is the same minimum for every start, apart from rounding. Equal
/// sequences of calls give bitwise equal results.
///
/// Solve() allocates no memory.
class QpSolver {
 public:
  enum class Status : std::uint8_t {
    kOptimal,         // solution() is the minimum
    kInfeasible,      // no x meets all limits
    kIterationLimit,  // stopped at max_iterations; solution() violates at least one limit
  };

  struct Options {
    std::int64_t max_iterations = 1000;
    // A limit counts as met if it is violated by at most `tolerance`, in the units of its row of C.
    double tolerance = 1e-10;
  };

  struct Result {
    Status status = Status::kOptimal;
    std::int64_t iterations = 0;  // steps of the method; each adds or drops one limit
  };

  /// @param hessian H, n x n, symmetric
  /// @param constraints C, m x n, without rows of zeros
  /// @throws std::domain_error if `hessian` is not positive definite to working precision.
  QpSolver(const Eigen::MatrixXd& hessian, const Eigen::MatrixXd& constraints,
           const Options& options);

  /// Solves the problem with this linear term g and these limits. `linear` has n entries, `lower`
  /// and `upper` have m entries; an infinite limit has no effect.
  Result Solve(const Eigen::VectorXd& linear, const Eigen::VectorXd& lower,
               const Eigen::VectorXd& upper);

  /// H^-1 times each column of `columns`. For a linear term g, H^-1 g is minus the unconstrained
  /// minimum.
  Eigen::MatrixXd SolveHessian(const Eigen::MatrixXd& columns) const;

  /// Empties the active set. The next Solve() starts without active limits, like the first Solve().
  void Restart() { active_ = 0; }

  /// x of the last Solve().
  const Eigen::VectorXd& solution() const { return x_; }

  /// After kOptimal, the Lagrange multiplier y of every row: H x + g = C' y. y > 0 only if the
  /// lower limit is active, y < 0 only if the upper limit is active, otherwise y = 0.
  const Eigen::VectorXd& multipliers() const { return multipliers_; }

 private:
  // One of the two limits of a row: side * (c'x - limit) >= 0.
  struct Limit {
    Eigen::Index row;
    double side;       // 1: lower, -1: upper
    double violation;  // amount by which the limit is violated
  };

  // The part of a row of C between its outermost nonzeros.
  struct Span {
    Eigen::Index begin;
    Eigen::Index size;
  };

  enum class StepKind : std::uint8_t { kAdded, kDropped, kInfeasible };

  void StartFromActiveSet(const Eigen::VectorXd& linear, const Eigen::VectorXd& lower,
                          const Eigen::VectorXd& upper);
  Limit MostViolated(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) const;
  StepKind Step(Limit& limit, double& multiplier);
  double SplitNormal(const Limit& limit);
  void Add(const Limit& limit, double multiplier, double norm);
  void Drop(Eigen::Index position);
  double Value(Eigen::Index row) const;  // value of c'x

  Options options_;
  // The constant part of the problem; n variables, m rows.
  Eigen::MatrixXd inverse_factor_;  // n x n, L^-1, lower triangular
  Eigen::MatrixXd rows_;            // n x m, C'
  std::vector<Span> spans_;         // m

  // The active set; the first `active_` columns and entries count.
  Eigen::Index active_ = 0;
  std::vector<Eigen::Index> set_;  // n, rows of the active limits
  Eigen::VectorXd sides_;          // n, sides of the active limits
  Eigen::VectorXd lambda_;         // n, multipliers of the active limits, >= 0
  Eigen::MatrixXd q_;              // n x n, orthonormal basis of the active normals
  Eigen::MatrixXd r_;              // n x n, upper triangular: active normals = Q R

  // The limit that is being added has the normal Q along_ + rest_.
  Eigen::VectorXd along_;             // n, the first `active_` entries count
  Eigen::VectorXd rest_;              // n, orthogonal to Q
  Eigen::VectorXd correction_;        // n, correction of `along_`
  Eigen::VectorXd dual_direction_;    // n, decrease of lambda_ per unit of step
  Eigen::VectorXd primal_direction_;  // n, change of x_ per unit of step

  Eigen::VectorXd scaled_;       // n, L'x at the start of Solve()
  Eigen::VectorXd x_;            // n
  Eigen::VectorXd multipliers_;  // m
};

}  // namespace fogline::acc
