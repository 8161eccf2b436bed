#include "services/acc/acc_controller.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/errors.h"

namespace fogline::acc {
namespace {

// Tolerance in m/s2. A car has followed its command if acceleration and command differ by at most
// this tolerance. The tolerance is far above the rounding errors of the integration over substeps,
// and far below any difference that a person notices.
constexpr double kSameAcceleration = 1e-6;

QpSolver MakeSolver(const AccProgram& program, const AccSection& section) {
  try {
    return QpSolver(
        program.hessian(), program.constraints(),
        {.max_iterations = section.max_iterations, .tolerance = AccProgram::kTolerance});
  } catch (const std::domain_error&) {
    throw InputError(
        "ACC: the weights make an ill-conditioned problem; raise weight_control or lower the other "
        "weights or horizon_steps");
  }
}

}  // namespace

AccController::AccController(const AccSection& section, double step_s, VehicleModel vehicle)
    : section_(section),
      step_s_(step_s),
      vehicle_(vehicle),
      program_(section, step_s),
      solver_(MakeSolver(program_, section)) {
  const Eigen::Index n = program_.horizon();
  unconstrained_ = LinearPlan(-solver_.SolveHessian(program_.gradient()).bottomRows(n));
  linear_.setZero(n + 1);
  lower_.setZero(program_.constraints().rows());
  upper_.setZero(program_.constraints().rows());
  plan_.setZero(n);
}

void AccController::Restart(const AccSection& section, double step_s, VehicleModel vehicle) {
  if (section != section_ || step_s != step_s_) {
    *this = AccController(section, step_s, vehicle);
    return;
  }
  vehicle_ = vehicle;
  solver_.Restart();
  plan_.setZero();
  has_plan_ = true;
  control_ = 0;
  acceleration_mps2_ = 0;
}

AccController::Output AccController::Step(const Input& input) {
  const double safe_distance = SafeDistance(section_, input.speed_mps);
  const AccSituation now{
      .state = {input.distance_m - safe_distance, input.relative_speed_mps,
                input.acceleration_mps2},
      .speed_mps = input.speed_mps,
      .previous_control = PreviousControl(input.acceleration_mps2),
  };
  Output output{.acceleration_mps2 = 0,
                .control = 0,
                .safe_distance_m = safe_distance,
                .solver = Solver::kFallback,
                .iterations = 0};
  std::optional<double> control;
  if (input.has_target) control = Solve(now, output);
  output.control = control ? *control : program_.FallbackControl(now.previous_control);
  output.acceleration_mps2 = CommandOf(output.control, input.acceleration_mps2);
  control_ = output.control;
  acceleration_mps2_ = output.acceleration_mps2;
  return output;
}

std::span<const double> AccController::plan() {
  if (!has_plan_) unconstrained_.Compute(situation_, plan_);
  has_plan_ = true;
  return {plan_.data(), static_cast<std::size_t>(plan_.size())};
}

double AccController::CommandOf(double control, double acceleration_mps2) const {
  if (vehicle_ == VehicleModel::kLongitudinal) return -section_.engine_gain * control;
  const DiscreteAccModel& model = program_.model();
  return model.phi(kOwnAcceleration, kOwnAcceleration) * acceleration_mps2 +
         model.gamma(kOwnAcceleration) * control;
}

// The value of u before this step, from which the rate limit of u starts. If the car followed its
// command, this value is the u of the controller's last step. Otherwise the value is the u that
// would keep the car's acceleration. The value is clamped to the limits of u, because a human
// driver may have braked harder than the automation may.
//
// A longitudinal vehicle never follows its command exactly. For such a vehicle, the value is the u
// of the last step, but its distance from the u that would keep the acceleration is limited to
// T_e jerk_max / K_e. The model's engine lags behind u by this distance while u changes at the jerk
// limit. Because of the limited distance, u cannot drift away while the human drives.
double AccController::PreviousControl(double acceleration_mps2) const {
  const double holding = -acceleration_mps2 / section_.engine_gain;
  double control = holding;
  if (vehicle_ == VehicleModel::kLongitudinal) {
    const double lead =
        section_.max_jerk_mps3 * section_.engine_time_constant_s / section_.engine_gain;
    control = std::clamp(control_, holding - lead, holding + lead);
  } else if (std::abs(acceleration_mps2 - acceleration_mps2_) <= kSameAcceleration) {
    control = control_;
  }
  return std::clamp(control, program_.MinControl(), program_.MaxControl());
}

// Returns u_0 of the plan; nullopt if there is no plan.
std::optional<double> AccController::Solve(const AccSituation& now, Output& output) {
  situation_ << now.state(kDeltaD), now.state(kDeltaV), now.state(kOwnAcceleration),
      now.previous_control;
  has_plan_ = false;
  if (program_.IsCertainlyWithinLimits(now, unconstrained_.ControlBound(situation_),
                                       unconstrained_.ChangeBound(situation_)) ||
      program_.IsWithinLimits(now, plan())) {
    output.solver = Solver::kUnconstrained;
    return unconstrained_.First(situation_);
  }
  linear_.noalias() = program_.gradient() * situation_;
  program_.Limits(now, lower_, upper_);
  const QpSolver::Result result = solver_.Solve(linear_, lower_, upper_);
  output.iterations = static_cast<std::int32_t>(result.iterations);
  if (result.status != QpSolver::Status::kOptimal) return std::nullopt;
  output.solver = Solver::kActiveSet;
  plan_ = solver_.solution().tail(plan_.size());
  return plan_(0);
}

}  // namespace fogline::acc
