// The controller of the ACC, for the host and for following cars.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "scenario/sections/control.h"
#include "scenario/sections/vehicle.h"
#include "services/acc/acc_program.h"
#include "services/acc/linear_plan.h"
#include "services/acc/qp.h"

namespace fogline::acc {

/// Model predictive adaptive cruise control: keeps the safe distance d_r = T_hw v + d_0 to the
/// preceding car (symbols: acc_model.h). The inputs are distance, speeds and acceleration. The
/// controller has no access to sensors or messages, and does not know which side drives.
///
/// The unconstrained optimum is linear in the situation, so its gain is computed only in the
/// constructor. If the plan that this gain gives meets every limit, the controller uses this plan.
/// Otherwise the controller solves the quadratic program.
///
/// A point mass applies a command without delay. So the command for a point mass is the model's
/// acceleration one step ahead. The model starts from the car's actual acceleration, so the command
/// does not jump after a take-over.
///
/// A longitudinal vehicle itself delays a command, so its command does not contain the lag of the
/// model. The command is -K_e u, the steady acceleration that the control u causes. Before each
/// step, the controller limits the difference between the last command and the vehicle's
/// acceleration to T_e max_jerk_mps3. The reason for this limit: while a command changes at the
/// jerk limit, the acceleration of the model's engine is behind the command by T_e max_jerk_mps3.
class AccController {
 public:
  struct Input {
    double distance_m;          // to the preceding car
    double relative_speed_mps;  // speed of the preceding car minus own speed
    double speed_mps;           // own speed
    double acceleration_mps2;   // own acceleration during the step that ended now
    bool has_target;            // whether distance_m and relative_speed_mps are valid
  };

  /// The way in which a command was computed; accel_command_t uses the same numbers.
  enum class Solver : std::int8_t {
    kUnconstrained = 0,  // the precomputed optimum, within all limits
    kActiveSet = 1,      // the optimum on the limits
    kFallback = 2,       // no target, or no optimum within the iteration limit
  };

  struct Output {
    double acceleration_mps2;  // command: C x(k+1) of a point mass, -K_e u(k) of a vehicle
    double control;            // u(k); a positive u decelerates
    double safe_distance_m;    // d_r at the own speed
    Solver solver;
    std::int32_t iterations;  // iterations of the active-set solver
  };

  /// @throws InputError if the section's weights make an ill-conditioned problem.
  /// @param vehicle model of the car that receives the commands
  AccController(const AccSection& section, double step_s,
                VehicleModel vehicle = VehicleModel::kPointMass);

  Output Step(const Input& input);

  /// Resets the object to the state of a new AccController(section, step_s, vehicle). If section
  /// and step_s are unchanged, the object keeps the results of its construction. Computing these
  /// results again would take most of the time of a short run.
  /// @throws InputError under the same condition as the constructor; the object is then unchanged.
  void Restart(const AccSection& section, double step_s,
               VehicleModel vehicle = VehicleModel::kPointMass);

  /// The plan u_0, ..., u_{N-1} of the last step, if the solver of this step was kUnconstrained or
  /// kActiveSet. After kFallback the result has no meaning. If Step() did not need the whole plan,
  /// plan() computes the plan.
  std::span<const double> plan();

 private:
  double PreviousControl(double acceleration_mps2) const;
  double CommandOf(double control, double acceleration_mps2) const;
  std::optional<double> Solve(const AccSituation& now, Output& output);

  AccSection section_;
  double step_s_;
  VehicleModel vehicle_;
  AccProgram program_;
  QpSolver solver_;
  LinearPlan unconstrained_;
  Eigen::Vector4d situation_;  // [x; u_{-1}] of the last step
  Eigen::VectorXd linear_;
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  Eigen::VectorXd plan_;
  bool has_plan_ = true;  // whether plan_ is the plan of the last step

  // Results of the last step.
  double control_ = 0;
  double acceleration_mps2_ = 0;
};

}  // namespace fogline::acc
