// The quadratic program that the ACC's model predictive control solves in every step.
#pragma once

#include <span>

#include <Eigen/Core>

#include "scenario/sections/control.h"
#include "services/acc/acc_model.h"

namespace fogline::acc {

/// The situation from which a plan starts.
struct AccSituation {
  Eigen::Vector3d state;    // x(k), see AccState
  double speed_mps;         // own speed
  double previous_control;  // u of the previous step, between MinControl() and MaxControl()
};

/// The quadratic program over a horizon of N steps of h seconds. The program is condensed: the
/// states are eliminated, and the unknowns are z = [s, u_0, ..., u_{N-1}]. The prediction assumes
/// that the preceding car keeps its speed.
///
///     min  sum_{j=1..N}   w_d delta_d_j^2 + w_v delta_v_j^2 + w_a a_j^2
///        + sum_{j=0..N-1} w_u u_j^2 + w_du (u_j - u_{j-1})^2     + w_s s^2
///
///     limits of u         -a_max / K_e <= u_j <= -a_min / K_e
///     of its change       |u_j - u_{j-1}| <= h jerk_max / K_e
///     of the speed        w_j <= max(v_max, w_j under the fall-back plan)
///     no reversing        w_j >= -s / (1 second)
///     of the gap          d_j >= d_min - s (N + 1 - j) / N
///
/// delta_d, delta_v and a are the elements of the state, and T_e and K_e are parameters
/// (acc_model.h). The weights w_d to w_s, and a_min, a_max, jerk_max, v_max and d_min, are fields
/// of AccSection. d_j is the gap, and v_j the own speed, after j steps.
///
/// w = v + T_e a is the speed at which the car settles if u is 0 from now on. The time derivative
/// of w is w' = -K_e u. T_e v' = w - v, so the speed stays below v_max while w stays below v_max,
/// even between the steps. In the same way, the speed stays at or above 0 while w stays at or above
/// 0. (Limits on v_j itself would be less cautious. But u acts on v with a delay, so limits on v_j
/// would make the optimum oscillate from step to step.)
///
/// In the fall-back plan, u changes at the fastest allowed rate until it has the smaller of two
/// values: fallback_deceleration_mps2 / K_e, and the upper limit of u. The fall-back plan meets the
/// first three limits in every situation. s >= 0 can grow until the last two limits are met, so the
/// program always has a solution. If the human has driven faster than v_max, the car comes below
/// v_max at least as early as with the fall-back plan. s, in m, is the shortfall of the gap that
/// the plan allows in its first step. The allowed shortfall decreases towards the end of the
/// horizon. Without this decrease, a gap that is too small at the start could stay too small. The
/// program needs no limit s >= 0, because s < 0 never costs less than s = 0.
class AccProgram {
 public:
  /// Tolerance (m/s2, m/s or m). A limit that is violated by at most this tolerance counts as met.
  /// The tolerance is far above rounding errors, and far below any difference that matters for a
  /// car.
  static constexpr double kTolerance = 1e-10;

  AccProgram(const AccSection& section, double step_s);

  Eigen::Index horizon() const { return horizon_; }
  const DiscreteAccModel& model() const { return model_; }

  /// The matrices H and G of the cost 1/2 z'Hz + (G p)'z + constant, where p = [x(k); u_{-1}] is
  /// the situation. H is (N+1) x (N+1). The first row and column of H belong to s, and are zero
  /// except on the diagonal. G is (N+1) x 4.
  const Eigen::MatrixXd& hessian() const { return hessian_; }
  const Eigen::MatrixXd& gradient() const { return gradient_; }

  /// Matrix C of the limits, 5N x (N+1): five rows for each step.
  const Eigen::MatrixXd& constraints() const { return constraints_; }

  /// Limits of C z. If no plan within the limits of u can reach a limit of the speed within the
  /// horizon, both limits of the speed are infinite. The same rule applies to the limit of the gap.
  void Limits(const AccSituation& now, Eigen::VectorXd& lower, Eigen::VectorXd& upper) const;

  /// Whether a plan u_0, ..., u_{N-1} meets every limit with s = 0.
  bool IsWithinLimits(const AccSituation& now, std::span<const double> controls) const;

  /// Whether the bounds of a plan prove that IsWithinLimits() is true for this plan. If the result
  /// is false, IsWithinLimits() may still be true. If the result is true, rounding cannot make
  /// IsWithinLimits() false, because rounding errors are far below kTolerance.
  /// @param largest_control upper bound of every |u_j| of the plan
  /// @param largest_change upper bound of every |u_j - u_{j-1}|, with u_{-1} = now.previous_control
  bool IsCertainlyWithinLimits(const AccSituation& now, double largest_control,
                               double largest_change) const;

  double MinControl() const { return min_control_; }
  double MaxControl() const { return max_control_; }

  /// u of the fall-back plan after a step with `previous_control`.
  double FallbackControl(double previous_control) const;

 private:
  // Whether a plan within the limits of u can reach a limit of the speed (`speed`), and whether it
  // can reach the limit of the gap (`gap`).
  struct Reach {
    bool speed;
    bool gap;
  };

  void BuildCost(const AccSection& section);
  void BuildConstraints();
  Reach ReachOf(const AccSituation& now) const;
  bool SpeedsAreWithinLimits(const AccSituation& now, std::span<const double> controls) const;
  bool GapsAreWithinLimits(const AccSituation& now, std::span<const double> controls) const;

  double SettledSpeed(const AccSituation& now) const;
  double Gap(const Eigen::Vector3d& state, double preceding_mps) const;
  Eigen::Vector3d Advance(const Eigen::Vector3d& state, double control) const {
    return model_.phi * state + model_.gamma * control;
  }

  AccSection section_;
  Eigen::Index horizon_;
  double duration_s_;
  DiscreteAccModel model_;
  double min_control_;
  double max_control_;
  double max_control_change_;
  double speed_per_control_;  // change of w over a step with u = 1
  double fallback_control_;
  Eigen::Matrix3Xd response_;  // 3 x N; column j - 1 is x(j) after u = 1 in step 0 only
  Eigen::MatrixXd hessian_;
  Eigen::MatrixXd gradient_;
  Eigen::MatrixXd constraints_;
};

}  // namespace fogline::acc
