// Longitudinal model of the ACC: a car with a first-order engine behind a preceding car.
#pragma once

#include <Eigen/Core>

#include "scenario/sections/control.h"

namespace fogline::acc {

/// Order of the elements of the state x = [delta_d, delta_v, a]. delta_d is the distance minus the
/// safe distance d_r = T_hw v + d_0, in m. delta_v is the preceding car's speed minus the own
/// speed, in m/s. a is the own acceleration, in m/s2.
enum AccState : Eigen::Index { kDeltaD = 0, kDeltaV = 1, kOwnAcceleration = 2 };

/// The matrices of the model x' = A x + B u, y = C x, with the control u. The model assumes that
/// the preceding car keeps its speed:
///
///     A = [0 1 -T_hw; 0 0 -1; 0 0 -1/T_e]    B = [0; 0; -K_e/T_e]    C = [0 0 1]
///
/// as printed by Sourav & Cheng, RTSS 2024. T_hw, d_0, T_e and K_e are headway_s, standstill_m,
/// engine_time_constant_s and engine_gain of AccSection. Because of the sign of B, a positive u
/// decelerates, and a constant u causes the steady acceleration -K_e u. (Takahama & Akasaka 2018,
/// the source of this model, have +K_e/T_e in B.)
struct AccModel {
  Eigen::Matrix3d a;     // 3x3, A
  Eigen::Vector3d b;     // 3x1, B
  Eigen::RowVector3d c;  // 1x3, C
};

/// The matrices of the model in steps: x(k+1) = Phi x(k) + Gamma u(k).
struct DiscreteAccModel {
  Eigen::Matrix3d phi;
  Eigen::Vector3d gamma;
};

/// The AccModel with the parameters of `section`.
AccModel MakeAccModel(const AccSection& section);

/// The discrete model for steps of h = `step_s`. The discrete model is exact if u is constant over
/// each step (zero-order hold; Van Loan 1978): exp([A B; 0 0] h) = [Phi Gamma; 0 1].
DiscreteAccModel Discretise(const AccModel& model, double step_s);

/// The safe distance d_r = T_hw v + d_0 at the own speed v, in m.
inline double SafeDistance(const AccSection& section, double speed_mps) {
  return section.headway_s * speed_mps + section.standstill_m;
}

}  // namespace fogline::acc
