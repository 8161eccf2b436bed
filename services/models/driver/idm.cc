#include "services/models/driver/idm.h"

#include <algorithm>
#include <cmath>

namespace fogline::models {

Idm::Idm(const DriverSection& driver)
    : driver_(driver),
      twice_sqrt_ab_mps2_(
          2 * std::sqrt(driver.max_acceleration_mps2 * driver.comfortable_deceleration_mps2)) {}

double Idm::Acceleration(double speed_mps, double preceding_speed_mps, double gap_m) const {
  if (gap_m <= 0) return -driver_.max_deceleration_mps2;
  const double v = std::max(speed_mps, 0.0);
  const double gap_ratio = DesiredGap(v, preceding_speed_mps) / gap_m;
  const double speed_ratio = v / driver_.desired_speed_mps;
  const double acceleration = driver_.max_acceleration_mps2 *
                              (1 - std::pow(speed_ratio, driver_.exponent) - gap_ratio * gap_ratio);
  return std::max(acceleration, -driver_.max_deceleration_mps2);
}

double Idm::DesiredGap(double speed_mps, double preceding_speed_mps) const {
  const double v = speed_mps;
  const double closing_speed = v - preceding_speed_mps;
  const double dynamic_gap = v * driver_.headway_s + v * closing_speed / twice_sqrt_ab_mps2_;
  return driver_.standstill_m + std::max(0.0, dynamic_gap);
}

}  // namespace fogline::models
