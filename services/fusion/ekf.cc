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
  return jacobian.dot(jacobian * covariance_.topLeftCorner<2, 2>()) + noise_variance;
}

// The third column of I - K H is that of I, because no sensor measures a_p. So both products leave
// out its zeros. Each sum has the order a + (b + c), as a product of whole matrices has: another
// order would change the last bit of results.
void Ekf::Correct(const Jacobian& jacobian, double innovation, double noise_variance) {
  const Eigen::Vector3d gain = covariance_.leftCols<2>() * jacobian.transpose() /
                               InnovationVariance(jacobian, noise_variance);
  Eigen::Matrix<double, 3, 2> keep = -gain.lazyProduct(jacobian);  // I - K H without column 3
  keep(0, 0) += 1;
  keep(1, 1) += 1;
  state_ += gain * innovation;

  Covariance once = keep.col(1).lazyProduct(covariance_.row(1));  // (I - K H) P
  once.row(2) += covariance_.row(2);
  once += keep.col(0).lazyProduct(covariance_.row(0));
  Covariance twice = once.col(1).lazyProduct(keep.col(1).transpose());  // ... (I - K H)'
  twice.col(2) += once.col(2);
  twice += once.col(0).lazyProduct(keep.col(0).transpose());
  const Eigen::Vector3d noise = gain * noise_variance;
  SetCovariance(twice + noise.lazyProduct(gain.transpose()));
}

// Rounding differs between an element and its mirror image. Both elements get their mean, so that
// the covariance is symmetric to the last bit.
void Ekf::SetCovariance(const Covariance& covariance) {
  covariance_ = (covariance + covariance.transpose()) / 2;
}

}  // namespace fogline::fusion
