// A car ahead, and sensors. The car moves and the sensors measure exactly as the filter's model
// assumes.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "common/random.h"
#include "scenario/sections/scenario.h"
#include "services/graph.h"

namespace fogline::testing {

/// Truth and messages of one step.
struct LeadStep {
  Eigen::Vector3d truth;  // [distance, relative speed, relative acceleration]
  ego_t ego{};
  radar_t radar{};
  lidar_t lidar{};
};

/// The preceding car has white-noise jerk, the host brakes and accelerates, and the sensors have
/// white noise with the standard deviations that section `fusion` assumes.
class LeadSimulation {
 public:
  LeadSimulation(const Scenario& scenario, std::int64_t seed)
      : scenario_(scenario), random_(seed, Stream::kRadar) {
    const double t = scenario.step_s;
    transition_ << 1, t, t * t / 2, 0, 1, t, 0, 0, 1;
    input_ << -t * t / 2, -t, 0;
    // The process noise of a step: the integral of q v v' over the time s, with the jerk density q
    // and v = [s^2/2, s, 1], by Gauss's rule of 3 points. The rule is exact, because the elements
    // are polynomials of degree 4 at most.
    const double node = std::sqrt(0.6);
    Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
    for (const auto& [x, weight] :
         {std::pair{-node, 5.0 / 18}, {0.0, 8.0 / 18}, {node, 5.0 / 18}}) {
      const double s = t * (1 + x) / 2;
      const Eigen::Vector3d v(s * s / 2, s, 1);
      noise += t * weight * scenario.fusion.jerk_density_m2ps5 * v * v.transpose();
    }
    noise_root_ = noise.llt().matrixL();
    // The uncertainty of the initial state is the uncertainty that the filter assumes.
    const double spread = scenario.fusion.initial_acceleration_std_mps2;
    state_ << 60.0, 0.0, spread * random_.Normal2(0, 9)[0];
  }

  /// The probability that a sensor has no value in a step.
  void set_dropout(double probability) { dropout_ = probability; }

  LeadStep Step() {
    const double host_acceleration =
        step_ == 0 ? 0 : 1.5 * std::cos(2 * std::numbers::pi * static_cast<double>(step_) / 70);
    const auto [n0, n1] = random_.Normal2(step_, 0);
    const auto [n2, radar_range] = random_.Normal2(step_, 1);
    const auto [radar_rate, lidar_range] = random_.Normal2(step_, 2);
    const auto [radar_chance, lidar_chance] = random_.Uniform2(step_, 3);
    if (step_ > 0) {
      state_ = transition_ * state_ + input_ * host_acceleration +
               noise_root_ * Eigen::Vector3d(n0, n1, n2);
    }
    LeadStep out;
    out.truth = state_ - Eigen::Vector3d(0, 0, host_acceleration);
    out.ego.header.step = step_;
    out.ego.acceleration_mps2 = host_acceleration;
    const FusionSection& fusion = scenario_.fusion;
    const double r = std::hypot(state_[0], scenario_.radar.lateral_offset_m);
    const double l = std::hypot(state_[0], scenario_.lidar.lateral_offset_m);
    if (radar_chance >= dropout_) {
      out.radar.valid = 1;
      out.radar.range_m = r + fusion.radar_range_std_m * radar_range;
      out.radar.range_rate_mps =
          state_[0] * state_[1] / r + fusion.radar_range_rate_std_mps * radar_rate;
    }
    if (lidar_chance >= dropout_) {
      out.lidar.valid = 1;
      out.lidar.range_m = l + fusion.lidar_range_std_m * lidar_range;
    }
    ++step_;
    return out;
  }

 private:
  Scenario scenario_;
  Random random_;
  double dropout_ = 0;
  std::int64_t step_ = 0;
  Eigen::Matrix3d transition_;
  Eigen::Vector3d input_;
  Eigen::Matrix3d noise_root_;
  Eigen::Vector3d state_;
};

}  // namespace fogline::testing
