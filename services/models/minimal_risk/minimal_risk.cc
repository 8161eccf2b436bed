#include "services/models/minimal_risk/minimal_risk.h"

#include <algorithm>
#include <cmath>

namespace fogline::models {
namespace {

// Factor on the braking, so that the car really stands after the last step. Without this factor,
// rounding would leave a speed of 1e-17 m/s.
constexpr double kToRest = 1.0 + 1e-12;

}  // namespace

MinimalRisk::MinimalRisk(const MinimalRiskSection& limits, double step_s)
    : limits_(limits), step_s_(step_s) {}

void MinimalRisk::Begin(double acceleration_mps2) {
  if (begun_) return;
  begun_ = true;
  acceleration_mps2_ = acceleration_mps2;
}

double MinimalRisk::Step(double speed_mps, double deceleration_mps2) {
  const double change = limits_.jerk_mps3 * step_s_;
  if (speed_mps == 0.0 && acceleration_mps2_ <= change) {
    acceleration_mps2_ = 0.0;  // the car stands and is not about to drive off
    return acceleration_mps2_;
  }
  const double strongest = -std::min(deceleration_mps2, Releasable(speed_mps));
  acceleration_mps2_ =
      std::clamp(strongest, acceleration_mps2_ - change, acceleration_mps2_ + change);
  return acceleration_mps2_;
}

double MinimalRisk::Releasable(double speed_mps) const {
  const double change = limits_.jerk_mps3 * step_s_;
  const double steps =
      std::max(1.0, std::ceil(0.5 * (std::sqrt(1.0 + 8.0 * speed_mps / (change * step_s_)) - 1.0)));
  return kToRest * speed_mps / (steps * step_s_) + 0.5 * (steps - 1.0) * change;
}

}  // namespace fogline::models
