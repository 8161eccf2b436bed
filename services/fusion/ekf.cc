#include "services/fusion/ekf.h"

namespace fogline::fusion {

Ekf::Ekf(double step_s, double jerk_density_m2ps5) {
  const double t = step_s;
  const double t2 = t * t;
  const double t3 = t2 * t;
  const double t4 = t2 * t2;
  const double t5 = t4 * t;
  transition_ << 1, t, t2 / 2,  //
      0, 1, t,                  //
      0, 0, 1;
  input_ << -t2 / 2, -t, 0;
  process_noise_ << t5 / 20, t4 / 8, t3 / 6,  //
      t4 / 8, t3 / 3, t2 / 2,                 //
      t3 / 6, t2 / 2, t;
  process_noise_ *= jerk_density_m2ps5;
}

void Ekf::Start(const State& state, const Covariance& covariance) {
  state_ = state;
  SetCovariance(covariance);
}

void Ekf::Predict(double host_acceleration_mps2) {
  state_ = transition_ * state_ + input_ * host_acceleration_mps2;
  SetCovariance(transition_ * covariance_ * transition_.transpose() + process_noise_);
}

double Ekf::InnovationVariance(const Jacobian& jacobian, double noise_variance) const {
  return jacobian.dot(jacobian * covariance_) + noise_variance;
}

void Ekf::Correct(const Jacobian& jacobian, double innovation, double noise_variance) {
  const Eigen::Vector3d gain =
      covariance_ * jacobian.transpose() / InnovationVariance(jacobian, noise_variance);
  const Eigen::Matrix3d keep = Eigen::Matrix3d::Identity() - gain * jacobian;
  state_ += gain * innovation;
  SetCovariance(keep * covariance_ * keep.transpose() + gain * noise_variance * gain.transpose());
}

// Rounding differs between an element and its mirror image. Both elements get their mean, so that
// the covariance is symmetric to the last bit.
void Ekf::SetCovariance(const Covariance& covariance) {
  covariance_ = (covariance + covariance.transpose()) / 2;
}

}  // namespace fogline::fusion
