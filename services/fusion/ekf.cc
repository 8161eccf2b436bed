#include "services/fusion/ekf.h"

#include <cstring>

namespace fogline::fusion {
namespace {

/// Whether both covariances are equal to the last bit. If they are, every computation has the same
/// result with both.
bool AreSame(const Ekf::Covariance& a, const Ekf::Covariance& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}

/// Rounding differs between an element and its mirror image. Both elements get their mean, so that
/// the covariance is symmetric to the last bit.
Ekf::Covariance Symmetric(const Ekf::Covariance& covariance) {
  Ekf::Covariance symmetric = covariance;
  for (int row = 1; row < 3; ++row) {
    for (int column = 0; column < row; ++column) {
      const double mean = (covariance(row, column) + covariance(column, row)) / 2;
      symmetric(row, column) = mean;
      symmetric(column, row) = mean;
    }
  }
  return symmetric;
}

}  // namespace

Ekf::Ekf(double step_s, double jerk_density_m2ps5) : step_s_(step_s) {
  const double t = step_s;
  const double t2 = t * t;
  const double t3 = t2 * t;
  const double t4 = t2 * t2;
  const double t5 = t4 * t;
  input_ << -t2 / 2, -t, 0;
  process_noise_ << t5 / 20, t4 / 8, t3 / 6,  //
      t4 / 8, t3 / 3, t2 / 2,                 //
      t3 / 6, t2 / 2, t;
  process_noise_ *= jerk_density_m2ps5;
}

void Ekf::Start(const State& state, const Covariance& covariance) {
  state_ = state;
  StepUpdates& step = steps_[step_];
  step.updates[0].covariance = Symmetric(covariance);
  step.known = 1;
  step.predicted = false;
  now_ = 0;
}

// F, the matrix of the prediction in ekf.h, has ones on its diagonal and zeros below its diagonal.
// The function leaves out the multiplications by these ones and zeros. The sums have the order
// a + (b + c), as in CorrectByBoth().
void Ekf::Predict(double host_acceleration_mps2) {
  const double t = step_s_;
  const double half_t2 = t * t / 2;
  state_(0) += t * state_(1) + half_t2 * state_(2);
  state_(1) += t * state_(2);
  state_ += input_ * host_acceleration_mps2;

  const Covariance& from = covariance();
  if (const StepUpdates* const kept = StepFrom(from)) {
    step_ = static_cast<std::size_t>(kept - steps_.data());
  } else {
    step_ = (step_ + 1) % steps_.size();
    StepUpdates& step = steps_[step_];
    step.predicted = true;
    step.from = from;
    Covariance p = from;
    p.row(0) += t * p.row(1) + half_t2 * p.row(2);  // F P
    p.row(1) += t * p.row(2);
    p.col(0) += t * p.col(1) + half_t2 * p.col(2);  // F P F'
    p.col(1) += t * p.col(2);
    step.updates[0].covariance = Symmetric(p + process_noise_);
    step.known = 1;
  }
  now_ = 0;
}

const Ekf::StepUpdates* Ekf::StepFrom(const Covariance& covariance) const {
  for (const StepUpdates& step : steps_) {
    // Most covariances differ in their first element, so the cheap comparison of this element comes
    // first.
    if (step.predicted && step.from(0, 0) == covariance(0, 0) && AreSame(step.from, covariance)) {
      return &step;
    }
  }
  return nullptr;
}

double Ekf::InnovationVariance(const Jacobian& jacobian, double noise_variance) const {
  return jacobian.dot(jacobian * covariance().topLeftCorner<2, 2>()) + noise_variance;
}

// Without a lateral offset, a value depends on one state alone. Then only the column of this state
// in I - K H differs from the column of I. The function leaves out all zeros, so it costs half as
// much as CorrectByBoth(). Both functions give equal results, bit by bit.
template <int kState>
void Ekf::CorrectBy(double slope, const Covariance& before, Update& update) {
  const double variance = slope * (slope * before(kState, kState)) + update.noise_variance;
  const Eigen::Vector3d gain = before.col(kState) * slope / variance;
  Eigen::Vector3d keep = -(gain * slope);  // column kState of I - K H
  keep(kState) += 1;

  Covariance once;  // (I - K H) P
  for (int row = 0; row < 3; ++row) {
    once.row(row) = keep(row) * before.row(kState);
    if (row != kState) once.row(row) += before.row(row);
  }
  const Eigen::Vector3d measured = once.col(kState);
  Covariance twice;  // ... (I - K H)'
  for (int column = 0; column < 3; ++column) {
    twice.col(column) = measured * keep(column);
    if (column != kState) twice.col(column) += once.col(column);
  }
  const Eigen::Vector3d noise = gain * update.noise_variance;
  update.gain = gain;
  update.covariance = Symmetric(twice + noise.lazyProduct(gain.transpose()));
}

// The third column of I - K H equals the third column of I, because no sensor measures a_p. So both
// products leave out the zeros of this column. Each sum has the order a + (b + c), as in a product
// of whole matrices. Another order would change the last bit of results.
void Ekf::CorrectByBoth(const Covariance& before, Update& update) {
  const Jacobian& jacobian = update.jacobian;
  const double variance =
      jacobian.dot(jacobian * before.topLeftCorner<2, 2>()) + update.noise_variance;
  const Eigen::Vector3d gain = before.leftCols<2>() * jacobian.transpose() / variance;
  Eigen::Matrix<double, 3, 2> keep = -gain.lazyProduct(jacobian);  // I - K H without column 3
  keep(0, 0) += 1;
  keep(1, 1) += 1;

  Covariance once = keep.col(1).lazyProduct(before.row(1));  // (I - K H) P
  once.row(2) += before.row(2);
  once += keep.col(0).lazyProduct(before.row(0));
  Covariance twice = once.col(1).lazyProduct(keep.col(1).transpose());  // ... (I - K H)'
  twice.col(2) += once.col(2);
  twice += once.col(0).lazyProduct(keep.col(0).transpose());
  const Eigen::Vector3d noise = gain * update.noise_variance;
  update.gain = gain;
  update.covariance = Symmetric(twice + noise.lazyProduct(gain.transpose()));
}

const Ekf::Update& Ekf::NextUpdate(const Jacobian& jacobian, double noise_variance) {
  StepUpdates& step = steps_[step_];
  if (now_ + 1 == step.updates.size()) Start(state_, covariance());
  const Covariance& before = covariance();
  Update& next = step.updates[++now_];
  if (now_ < step.known && next.jacobian == jacobian && next.noise_variance == noise_variance) {
    return next;
  }
  step.known = now_ + 1;
  next.jacobian = jacobian;
  next.noise_variance = noise_variance;
  if (jacobian(1) == 0) {
    CorrectBy<0>(jacobian(0), before, next);
  } else if (jacobian(0) == 0) {
    CorrectBy<1>(jacobian(1), before, next);
  } else {
    CorrectByBoth(before, next);
  }
  return next;
}

void Ekf::Correct(const Jacobian& jacobian, double innovation, double noise_variance) {
  state_ += NextUpdate(jacobian, noise_variance).gain * innovation;
}

}  // namespace fogline::fusion
