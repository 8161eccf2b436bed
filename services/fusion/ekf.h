// Extended Kalman filter for the car ahead, without sensors: prediction, and one scalar correction
// at a time. What a sensor sees is in line_of_sight.h; which measurements are used, in fusion.h.
#pragma once

#include <Eigen/Core>

namespace fogline {

/// State x = [d, dv, a_p]: distance (m) and relative speed (m/s) of the preceding car, preceding
/// minus host, and its *own* acceleration (m/s2). The host's acceleration a_h is known, so it
/// enters as an input and the host's braking is no disturbance to the estimate:
///
///     d+   = d + T dv + T^2/2 (a_p - a_h)
///     dv+  =       dv + T     (a_p - a_h)
///     a_p+ =                   a_p
///
/// which is exact while both accelerations are constant within a step. a_p is driven by white-noise
/// jerk of power spectral density q (Bar-Shalom, Li & Kirubarajan 2001, section 6.2.3).
///
/// The prediction is linear. Only a sensor that is off the lane's line makes a measurement
/// nonlinear; without lateral offsets this is a Kalman filter in the strict sense.
class Ekf {
 public:
  using State = Eigen::Vector3d;
  using Covariance = Eigen::Matrix3d;   // order of State, squared units
  using Jacobian = Eigen::RowVector3d;  // of one measured value with respect to State

  /// @param step_s T.  @param jerk_density_m2ps5 q.
  Ekf(double step_s, double jerk_density_m2ps5);

  /// Begins anew from an estimate and its (symmetric positive definite) covariance.
  void Start(const State& state, const Covariance& covariance);

  /// One step ahead, in which the host's acceleration was `host_acceleration_mps2` throughout.
  void Predict(double host_acceleration_mps2);

  /// Variance H P H' + R of the innovation of a value with Jacobian H and noise variance R.
  double InnovationVariance(const Jacobian& jacobian, double noise_variance) const;

  /// Corrects the estimate by one measured value. `innovation` is measured minus predicted. In
  /// Joseph's form, P = (I - K H) P (I - K H)' + K R K', which keeps P positive definite whatever
  /// the rounding of K (Bucy & Joseph 1968).
  void Correct(const Jacobian& jacobian, double innovation, double noise_variance);

  const State& state() const { return state_; }
  const Covariance& covariance() const { return covariance_; }

 private:
  void SetCovariance(const Covariance& covariance);

  Eigen::Matrix3d transition_;     // F
  Eigen::Vector3d input_;          // of the host's acceleration
  Eigen::Matrix3d process_noise_;  // Q
  State state_ = State::Zero();
  Covariance covariance_ = Covariance::Zero();
};

}  // namespace fogline
