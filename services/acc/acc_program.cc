#include "services/acc/acc_program.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fogline::acc {
namespace {

using Eigen::Index;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// The slack is the first unknown. If the slack were the last unknown, each row with a slack would
// have a nonzero last element. The solver would then use the whole row, including its zeros.
constexpr Index kSlack = 0;
constexpr Index kFirstControl = 1;

// Rows of C for each step, in this order.
enum Row : Index { kMaxSpeed, kStandstill, kMinGap, kControl, kControlChange, kRowsPerStep };

}  // namespace

AccProgram::AccProgram(const AccSection& section, double step_s)
    : section_(section),
      horizon_(section.horizon_steps),
      duration_s_(static_cast<double>(section.horizon_steps) * step_s),
      model_(Discretise(MakeAccModel(section), step_s)),
      min_control_(-section.max_acceleration_mps2 / section.engine_gain),
      max_control_(-section.min_acceleration_mps2 / section.engine_gain),
      max_control_change_(section.max_jerk_mps3 * step_s / section.engine_gain),
      speed_per_control_(-section.engine_gain * step_s),
      fallback_control_(
          std::min(section.fallback_deceleration_mps2 / section.engine_gain, max_control_)),
      response_(3, horizon_) {
  response_.col(0) = model_.gamma;
  for (Index j = 1; j < horizon_; ++j) response_.col(j) = model_.phi * response_.col(j - 1);
  BuildCost(section);
  BuildConstraints();
}

void AccProgram::BuildCost(const AccSection& section) {
  const Eigen::Vector3d weights(section.weight_distance, section.weight_speed,
                                section.weight_acceleration);
  const Index n = horizon_;
  hessian_.setZero(n + 1, n + 1);
  gradient_.setZero(n + 1, 4);
  hessian_(kSlack, kSlack) = 2 * section.min_gap_weight;

  // x(j) = Phi^j x(0) + sum_i response(j-1-i) u_i. The entries of this block are sums over j of
  // weighted products of responses. Each entry is its lower right neighbour plus one more product.
  auto controls = hessian_.bottomRightCorner(n, n);
  for (Index i = n - 1; i >= 0; --i) {
    for (Index k = i; k >= 0; --k) {
      const double last =
          2 * response_.col(n - 1 - i).dot(weights.cwiseProduct(response_.col(n - 1 - k)));
      controls(i, k) = last + (i + 1 < n ? controls(i + 1, k + 1) : 0.0);
      controls(k, i) = controls(i, k);
    }
  }
  Eigen::Matrix3d power = model_.phi;
  for (Index j = 0; j < n; ++j) {  // x(j + 1) depends on u_0, ..., u_j
    const Eigen::Matrix3d weighted = 2 * weights.asDiagonal() * power;
    for (Index i = 0; i <= j; ++i) {
      gradient_.row(kFirstControl + i).head<3>() += response_.col(j - i).transpose() * weighted;
    }
    power = power * model_.phi;
  }

  const double change = 2 * section.weight_control_change;
  for (Index j = 0; j < n; ++j) {
    controls(j, j) += 2 * section.weight_control + change;
    if (j == 0) continue;
    controls(j - 1, j - 1) += change;
    controls(j, j - 1) -= change;
    controls(j - 1, j) -= change;
  }
  gradient_(kFirstControl, 3) = -change;
}

void AccProgram::BuildConstraints() {
  const Index n = horizon_;
  constraints_.setZero(kRowsPerStep * n, n + 1);
  for (Index j = 0; j < n; ++j) {
    auto rows = constraints_.middleRows(kRowsPerStep * j, kRowsPerStep);
    rows(kControl, kFirstControl + j) = 1;
    rows(kControlChange, kFirstControl + j) = 1;
    if (j > 0) rows(kControlChange, kFirstControl + j - 1) = -1;
    for (Index i = 0; i <= j; ++i) {  // limits of the state at j + 1
      const auto response = response_.col(j - i);
      rows(kMaxSpeed, kFirstControl + i) = speed_per_control_;
      rows(kStandstill, kFirstControl + i) = speed_per_control_;
      rows(kMinGap, kFirstControl + i) = response(kDeltaD) - section_.headway_s * response(kDeltaV);
    }
    rows(kStandstill, kSlack) = 1;
    rows(kMinGap, kSlack) = static_cast<double>(n - j) / static_cast<double>(n);
  }
}

double AccProgram::FallbackControl(double previous_control) const {
  return std::clamp(fallback_control_, previous_control - max_control_change_,
                    previous_control + max_control_change_);
}

double AccProgram::SettledSpeed(const AccSituation& now) const {
  return now.speed_mps + section_.engine_time_constant_s * now.state(kOwnAcceleration);
}

double AccProgram::Gap(const Eigen::Vector3d& state, double preceding_mps) const {
  return state(kDeltaD) + SafeDistance(section_, preceding_mps - state(kDeltaV));
}

AccProgram::Reach AccProgram::ReachOf(const AccSituation& now) const {
  const double settled = SettledSpeed(now);
  const double fastest = settled + duration_s_ * section_.max_acceleration_mps2;
  const double slowest = settled + duration_s_ * section_.min_acceleration_mps2;
  // The gap under the strongest acceleration is concave in time, so its minimum is at one end of
  // the horizon.
  const double acceleration = std::max(now.state(kOwnAcceleration), section_.max_acceleration_mps2);
  const double gap = Gap(now.state, now.speed_mps + now.state(kDeltaV));
  const double last_gap =
      gap + duration_s_ * (now.state(kDeltaV) - 0.5 * duration_s_ * acceleration);
  return {.speed = fastest > section_.max_speed_mps || slowest < 0,
          .gap = std::min(gap, last_gap) < section_.min_gap_m};
}

void AccProgram::Limits(const AccSituation& now, Eigen::VectorXd& lower,
                        Eigen::VectorXd& upper) const {
  lower.setConstant(-kNoLimit);
  upper.setConstant(kNoLimit);
  const Reach reach = ReachOf(now);
  const double settled = SettledSpeed(now);
  const double preceding_mps = now.speed_mps + now.state(kDeltaV);
  double previous = now.previous_control;  // u_{-1} for step 0; then 0, because C has u_{j-1}
  double control = now.previous_control;   // u of the fall-back plan
  double fallback = settled;
  Eigen::Vector3d free = now.state;  // the state if every u were 0
  for (Index j = 0; j < horizon_; ++j) {
    auto low = lower.segment<kRowsPerStep>(kRowsPerStep * j);
    auto high = upper.segment<kRowsPerStep>(kRowsPerStep * j);
    low(kControl) = min_control_;
    high(kControl) = max_control_;
    low(kControlChange) = previous - max_control_change_;
    high(kControlChange) = previous + max_control_change_;
    previous = 0;
    if (reach.speed) {
      control = FallbackControl(control);
      fallback += speed_per_control_ * control;
      high(kMaxSpeed) = std::max(section_.max_speed_mps, fallback) - settled;
      low(kStandstill) = -settled;
    }
    if (reach.gap) {
      free = Advance(free, 0);
      low(kMinGap) = section_.min_gap_m - Gap(free, preceding_mps);
    }
  }
}

bool AccProgram::IsWithinLimits(const AccSituation& now, std::span<const double> controls) const {
  // The sign bit of a difference shows on which side of a limit a value lies. The compiler
  // vectorises these loops. It would not vectorise comparisons, because comparisons can raise
  // floating-point flags.
  const auto bits = [](double difference) { return std::bit_cast<std::int64_t>(difference); };
  const double lowest = min_control_ - kTolerance;
  const double highest = max_control_ + kTolerance;
  const double largest_change = max_control_change_ + kTolerance;
  const double first_change = controls.front() - now.previous_control;
  std::int64_t violated = bits(largest_change - std::abs(first_change));
  for (const double u : controls) violated |= bits(u - lowest) | bits(highest - u);
  for (std::size_t j = 1; j < controls.size(); ++j) {
    violated |= bits(largest_change - std::abs(controls[j] - controls[j - 1]));
  }
  // If an element of the situation is not a number, every control is not a number. So checking the
  // first change is sufficient.
  if (violated < 0 || std::isnan(first_change)) return false;
  const Reach reach = ReachOf(now);
  return (!reach.speed || SpeedsAreWithinLimits(now, controls)) &&
         (!reach.gap || GapsAreWithinLimits(now, controls));
}

bool AccProgram::IsCertainlyWithinLimits(const AccSituation& now, double largest_control,
                                         double largest_change) const {
  if (!(largest_control <= std::min(-min_control_, max_control_))) return false;
  if (!(largest_change <= max_control_change_)) return false;
  const Reach reach = ReachOf(now);
  return !reach.speed && !reach.gap;
}

bool AccProgram::SpeedsAreWithinLimits(const AccSituation& now,
                                       std::span<const double> controls) const {
  double settled = SettledSpeed(now);
  double fallback = settled;
  double control = now.previous_control;
  for (const double u : controls) {
    control = FallbackControl(control);
    fallback += speed_per_control_ * control;
    settled += speed_per_control_ * u;
    const double limit = std::max(section_.max_speed_mps, fallback);
    if (settled > limit + kTolerance || settled < -kTolerance) return false;
  }
  return true;
}

bool AccProgram::GapsAreWithinLimits(const AccSituation& now,
                                     std::span<const double> controls) const {
  const double preceding_mps = now.speed_mps + now.state(kDeltaV);
  Eigen::Vector3d state = now.state;
  for (const double u : controls) {
    state = Advance(state, u);
    if (Gap(state, preceding_mps) < section_.min_gap_m - kTolerance) return false;
  }
  return true;
}

}  // namespace fogline::acc
