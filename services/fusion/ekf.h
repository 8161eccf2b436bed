// Extended Kalman filter for the car ahead: prediction, and correction by one scalar value at a
// time. line_of_sight.h has the model of a sensor; fusion.h decides which measurements are used.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace fogline::fusion {

/// State x = [d, dv, a_p]: distance (m) and relative speed (m/s) of the preceding car, preceding
/// minus host, and the *own* acceleration of the preceding car (m/s2). The host's acceleration a_h
/// is known, so it enters as an input, and the host's braking does not disturb the estimate:
///
///     d+   = d + T dv + T^2/2 (a_p - a_h)
///     dv+  =       dv + T     (a_p - a_h)
///     a_p+ =                   a_p
///
/// This prediction is exact if both accelerations are constant within a step. White-noise jerk of
/// power spectral density q drives a_p (Bar-Shalom, Li & Kirubarajan 2001, section 6.2.3).
///
/// The prediction is linear. Only the lateral offset of a sensor makes a measurement nonlinear;
/// without lateral offsets, the filter is a Kalman filter in the strict sense.
class Ekf {
 public:
  using State = Eigen::Vector3d;
  using Covariance = Eigen::Matrix3d;  // order of State; units: products of State's units
  /// Derivative of one measured value with respect to [d, dv]. No sensor measures a_p.
  using Jacobian = Eigen::RowVector2d;

  /// @param step_s T.  @param jerk_density_m2ps5 q.
  Ekf(double step_s, double jerk_density_m2ps5);

  /// Sets the estimate and its (symmetric positive definite) covariance.
  void Start(const State& state, const Covariance& covariance);

  /// Predicts one step ahead; `host_acceleration_mps2` is the host's acceleration during this step.
  void Predict(double host_acceleration_mps2);

  /// Variance H P H' + R of the innovation of a value with Jacobian H (with a 0 for a_p) and noise
  /// variance R.
  double InnovationVariance(const Jacobian& jacobian, double noise_variance) const;

  /// Corrects the estimate by one measured value. `innovation` is measured minus predicted. The
  /// function uses Joseph's form, P = (I - K H) P (I - K H)' + K R K'. With this form, P stays
  /// positive definite even if K has rounding errors (Bucy & Joseph 1968).
  void Correct(const Jacobian& jacobian, double innovation, double noise_variance);

  const State& state() const { return state_; }
  const Covariance& covariance() const { return steps_[step_].updates[now_].covariance; }

 private:
  /// The covariance after a prediction or a correction. For a correction, the object also has the
  /// value's Jacobian and noise variance, and the gain, which depends on the covariance, too.
  struct Update {
    Jacobian jacobian = Jacobian::Zero();
    double noise_variance = 0;
    State gain = State::Zero();  // K
    Covariance covariance = Covariance::Zero();
  };
  /// The updates of one step: the prediction, and one for each value.
  struct StepUpdates {
    bool predicted = false;                // whether the first update is a prediction
    Covariance from = Covariance::Zero();  // the covariance before this prediction
    std::size_t known = 1;  // number of valid updates; each continues the update before it
    std::array<Update, 4> updates;
  };

  // Computes the update of Correct() for a value that depends only on state kState, with the
  // derivative `slope`.
  template <int kState>
  static void CorrectBy(double slope, const Covariance& before, Update& update);
  // Computes the update of Correct() for any Jacobian.
  static void CorrectByBoth(const Covariance& before, Update& update);
  /// The kept step whose prediction begins with this covariance. Null if no kept step does so.
  const StepUpdates* StepFrom(const Covariance& covariance) const;
  /// Goes on to the update for a value with this Jacobian and noise, and returns it.
  const Update& NextUpdate(const Jacobian& jacobian, double noise_variance);

  double step_s_;                  // T
  Eigen::Vector3d input_;          // effect of the host's acceleration
  Eigen::Matrix3d process_noise_;  // Q
  State state_ = State::Zero();
  // The covariance depends on the Jacobians and the noise variances, and not on the measured values
  // themselves. If Jacobians and noise variances are the same in each step, the covariance becomes
  // constant to the last bit, or repeats a short cycle. So the updates of the last steps are kept,
  // and are used again.
  std::array<StepUpdates, 8> steps_;
  std::size_t step_ = 0;  // place of the present step in steps_
  std::size_t now_ = 0;   // place of the latest update in the present step
};

}  // namespace fogline::fusion
