// The ACC itself, for the host and a following car alike.
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "scenario/control.h"
#include "scenario/vehicle.h"
#include "services/acc/acc_program.h"
#include "services/acc/qp.h"

namespace fogline {

/// Model predictive adaptive cruise control: holds the safe distance d_r = T_hw v + d_0 to the
/// preceding car. Knows distances and speeds, and nothing of sensors, messages or who drives.
///
/// The unconstrained optimum is linear in the situation, so its gain is computed once; a plan that
/// meets every limit is taken as it is, and only otherwise is the quadratic program solved.
/// To a point mass, which does at once what it is told, the command is the model's acceleration one
/// step ahead, from the acceleration that the car really has: whoever drove before, it goes on from
/// there. A vehicle has a lag of its own in the place of the model's: its command is the
/// acceleration -K_e u that u asks for, and its u is ahead of the acceleration that it has by no
/// more than the model's engine would be behind at the jerk limit.
class AccController {
 public:
  struct Input {
    double distance_m;          // to the preceding car
    double relative_speed_mps;  // preceding minus own
    double speed_mps;           // own
    double acceleration_mps2;   // applied during the step that ended now
    bool has_target;            // whether the first two mean something
  };

  /// Where a command comes from; the numbers are those of accel_command_t.
  enum class Solver : std::int8_t {
    kUnconstrained = 0,  // the precomputed optimum, within all limits
    kActiveSet = 1,      // the optimum on the limits
    kFallback = 2,       // no target, or no optimum within the iteration limit
  };

  struct Output {
    double acceleration_mps2;  // C x(k+1) of a point mass, -K_e u(k) of a vehicle
    double control;            // u(k); positive decelerates
    double safe_distance_m;    // d_r at the own speed
    Solver solver;
    std::int32_t iterations;  // of the active-set solver
  };

  /// @throws InputError if the section's weights make no well-conditioned problem.
  /// @param vehicle what obeys the commands
  AccController(const AccSection& section, double step_s,
                VehicleModel vehicle = VehicleModel::kPointMass);

  Output Step(const Input& input);

  /// Begins anew, as AccController(section, step_s, vehicle) would, and keeps what is computed once
  /// if these are the parameters that it has: most of the cost of a short run.
  /// @throws InputError as the constructor; it is then as it was.
  void Restart(const AccSection& section, double step_s,
               VehicleModel vehicle = VehicleModel::kPointMass);

  /// u_0, ..., u_{N-1} of the last step with kUnconstrained or kActiveSet.
  std::span<const double> plan() const;

 private:
  double PreviousControl(double acceleration_mps2) const;
  double CommandOf(double control, double acceleration_mps2) const;
  bool Solve(const AccSituation& now, Output& output);

  AccSection section_;
  double step_s_;
  VehicleModel vehicle_;
  AccProgram program_;
  QpSolver solver_;
  Eigen::Matrix4Xd gain_;  // 4 x N, unconstrained u_j = column j' [x; u_{-1}]
  Eigen::VectorXd linear_;
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  Eigen::VectorXd plan_;

  // Of the last step.
  double control_ = 0;
  double acceleration_mps2_ = 0;
};

}  // namespace fogline
