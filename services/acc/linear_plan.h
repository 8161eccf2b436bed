// The ACC's plan without limits, and bounds that often prove that this plan meets the limits.
#pragma once

#include <utility>

#include <Eigen/Core>

namespace fogline::acc {

/// The optimum without limits. It is linear in the situation p = [x(k); u_{-1}]: u = K p. x(k) is
/// the present state, and u_{-1} is the control of the previous step. If the whole plan meets the
/// limits, a controller needs only u_0. The two bounds below often prove that the plan meets the
/// limits. The bounds take far less computing time than the plan. By the triangle inequality,
///
///     |u_j|           <= sum_i max_j |K_ji| |p_i|
///     |u_j - u_{j-1}| <= sum_i max_j |K_ji - K_{j-1,i}| |p_i|,    where u_{-1} = p_4
class LinearPlan {
 public:
  LinearPlan() = default;

  /// @param gain K, N x 4
  explicit LinearPlan(Eigen::MatrixX4d gain) : gain_(std::move(gain)) {
    control_bound_ = gain_.cwiseAbs().colwise().maxCoeff();
    Eigen::RowVector4d previous(0, 0, 0, 1);  // u_{-1} as a function of p
    for (const auto& row : gain_.rowwise()) {
      change_bound_ = change_bound_.cwiseMax((row - previous).cwiseAbs());
      previous = row;
    }
  }

  Eigen::Index size() const { return gain_.rows(); }

  /// u_0, equal bit by bit to the first element of Compute().
  double First(const Eigen::Vector4d& p) const {
    return (gain_(0, 0) * p(0) + gain_(0, 1) * p(1)) + (gain_(0, 2) * p(2) + gain_(0, 3) * p(3));
  }

  /// Writes u_0, ..., u_{N-1} into `plan`.
  void Compute(const Eigen::Vector4d& p, Eigen::VectorXd& plan) const {
    // The compiler vectorises these sums, because they add whole columns.
    plan =
        (gain_.col(0) * p(0) + gain_.col(1) * p(1)) + (gain_.col(2) * p(2) + gain_.col(3) * p(3));
  }

  /// Upper bound of every |u_j|; not a number if an element of p is not a number.
  double ControlBound(const Eigen::Vector4d& p) const { return control_bound_.dot(p.cwiseAbs()); }

  /// Upper bound of every |u_j - u_{j-1}|; not a number if an element of p is not a number.
  double ChangeBound(const Eigen::Vector4d& p) const { return change_bound_.dot(p.cwiseAbs()); }

 private:
  Eigen::MatrixX4d gain_;
  Eigen::RowVector4d control_bound_ = Eigen::RowVector4d::Zero();
  Eigen::RowVector4d change_bound_ = Eigen::RowVector4d::Zero();
};

}  // namespace fogline::acc
