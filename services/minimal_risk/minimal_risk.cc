#include "services/minimal_risk/minimal_risk.h"

#include <algorithm>
#include <cmath>

namespace fogline {

MinimalRisk::MinimalRisk(const MinimalRiskSection& limits, double step_s)
    : limits_(limits), step_s_(step_s) {}

void MinimalRisk::Begin(double speed_mps, double acceleration_mps2) {
  if (begun_) return;
  begun_ = true;
  speed_mps_ = speed_mps;
  acceleration_mps2_ = acceleration_mps2;
}

double MinimalRisk::Step(std::optional<double> speed_mps) {
  if (speed_mps) {
    speed_mps_ = *speed_mps;
  } else if (!first_) {
    speed_mps_ = std::max(0.0, speed_mps_ + acceleration_mps2_ * step_s_);
  }
  first_ = false;
  const double change = limits_.jerk_mps3 * step_s_;
  if (speed_mps_ == 0.0 && acceleration_mps2_ <= change) {
    acceleration_mps2_ = 0.0;  // stands, and is not about to drive off
    return acceleration_mps2_;
  }
  const double strongest = -std::min(limits_.deceleration_mps2, Releasable(speed_mps_));
  acceleration_mps2_ =
      std::clamp(strongest, acceleration_mps2_ - change, acceleration_mps2_ + change);
  return acceleration_mps2_;
}

// Multiplied out, so that nothing cancels as v goes to 0: there r = 2 v / h, and the car stands
// after half a step.
double MinimalRisk::Releasable(double speed_mps) const {
  const double half_step_s = 0.5 * step_s_;
  return 2.0 * speed_mps /
         (half_step_s + std::sqrt(half_step_s * half_step_s + 2.0 * speed_mps / limits_.jerk_mps3));
}

}  // namespace fogline
