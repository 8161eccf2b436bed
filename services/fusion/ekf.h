// Extended Kalman filter for the car ahead: prediction, and correction by one scalar value at a
// time. line_of_sight.h has the model of a sensor. fusion.h chooses the values that correct the
// filter.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace fogline::fusion {

/// State x = [d, dv, a_p]. d is the distance to the preceding car (m), and dv the speed of this car
/// minus the host's speed (m/s). a_p is the acceleration of the preceding car itself, not relative
/// to the host (m/s2). The host's acceleration a_h is known and enters the prediction as an input.
/// So the host's braking does not disturb the estimate:
///
///     d+   = d + T dv + T^2/2 (a_p - a_h)
///     dv+  =       dv + T     (a_p - a_h)
///     a_p+ =                   a_p
///
/// This prediction is exact if both accelerations are constant within a step. White-noise jerk of
/// power spectral density q drives a_p (Bar-Shalom, Li & Kirubarajan 2001, section 6.2.3).
///
/// The prediction is linear. Only the lateral offset of a sensor makes a measurement nonlinear. So
/// without lateral offsets, the filter is a linear Kalman filter.
class Ekf {
 public:
  using State = Eigen::Vector3d;
  using Covariance = Eigen::Matrix3d;  // order of State; units: products of State's units
  /// Derivative of one measured value with respect to [d, dv]. No sensor measures a_p.
  using Jacobian = Eigen::RowVector2d;

  /// @param step_s T, the duration of a step
  /// @param jerk_density_m2ps5 q, the power spectral density of the jerk
  Ekf(double step_s, double jerk_density_m2ps5);

  /// Sets the estimate and its (symmetric positive definite) covariance.
  void Start(const State& state, const Covariance& covariance);

  /// Predicts one step ahead; `host_acceleration_mps2` is the host's acceleration during this step.
  void Predict(double host_acceleration_mps2);

  /// Variance of the innovation of a measured value: H P H' + R. H is the value's Jacobian, with a
  /// 0 added for a_p, and R is the value's noise variance.
  double InnovationVariance(const Jacobian& jacobian, double noise_variance) const;

  /// Corrects the estimate by one measured value. `innovation` is the measured value minus the
  /// predicted value. The function uses Joseph's form, P = (I - K H) P (I - K H)' + K R K'. With
  /// this form, P stays positive definite even if K has rounding errors (Bucy & Joseph 1968).
  void Correct(const Jacobian& jacobian, double innovation, double noise_variance);

  const State& state() const { return state_; }
  const Covariance& covariance() const { return steps_[step_].updates[now_].covariance; }

 private:
  /// The covariance after a prediction or a correction. For a correction, the object also has the
  /// value's Jacobian and noise variance, and the gain of this correction.
  struct Update {
    Jacobian jacobian = Jacobian::Zero();
    double noise_variance = 0;
    State gain = State::Zero();  // K
    Covariance covariance = Covariance::Zero();
  };
  /// The updates of one step: the prediction, and one correction for each value.
  struct StepUpdates {
    bool predicted = false;                // whether the first update is a prediction
    Covariance from = Covariance::Zero();  // the covariance before this prediction
    std::size_t known = 1;  // number of valid updates; each update continues the one before
    std::array<Update, 4> updates;
  };

  // Computes the update of Correct() for a value that depends only on state kState, with the
  // derivative `slope`.
  template <int kState>
  static void CorrectBy(double slope, const Covariance& before, Update& update);
  // Computes the update of Correct() for any Jacobian.
  static void CorrectByBoth(const Covariance& before, Update& update);
  /// The step in steps_ whose prediction begins with this covariance; nullptr if there is none.
  const StepUpdates* StepFrom(const Covariance& covariance) const;
  /// Goes on to the next update of this step: the correction by a value with this Jacobian and
  /// noise variance. Returns this update. Computes the update only if steps_ does not have it.
  const Update& NextUpdate(const Jacobian& jacobian, double noise_variance);

  double step_s_;                  // T
  Eigen::Vector3d input_;          // effect of the host's acceleration
  Eigen::Matrix3d process_noise_;  // Q
  State state_ = State::Zero();
  // The covariance depends on the Jacobians and the noise variances, and not on the measured values
  // themselves. If Jacobians and noise variances are the same in each step, the covariance becomes
  // constant to the last bit, or repeats a short cycle. So the filter keeps the updates of the last
  // steps, and uses them again.
  std::array<StepUpdates, 8> steps_;
  std::size_t step_ = 0;  // index of the present step in steps_
  std::size_t now_ = 0;   // index of the latest update in the present step
};

}  // namespace fogline::fusion
