#include "services/models/driver/following.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace fogline::models {
namespace {

constexpr double kFreeRoad_m = std::numeric_limits<double>::infinity();

// Upper limit of the exponent in z^(2 a / a_free). The exponent goes to infinity if v goes to v_0.
// The limit applies only if a_free is below 2 % of a, so its effect on the acceleration is small.
constexpr double kLargestExponent = 100;

}  // namespace

Following::Following(FollowingModel model, const DriverSection& driver, double coolness)
    : model_(model), driver_(driver), coolness_(coolness), idm_(driver) {
  if (!(coolness >= 0.0 && coolness <= 1.0)) {
    throw std::invalid_argument("following: coolness is outside [0, 1]");
  }
}

double Following::Acceleration(const Situation& seen) const {
  const double v = std::max(seen.speed_mps, 0.0);
  if (model_ == FollowingModel::kIdm) {
    return seen.ahead ? idm_.Acceleration(v, seen.ahead->speed_mps, seen.ahead->gap_m)
                      : idm_.Acceleration(v, v, kFreeRoad_m);
  }
  if (!seen.ahead) return std::max(FreeRoad(v), -driver_.max_deceleration_mps2);
  const CarAhead& ahead = *seen.ahead;
  if (ahead.gap_m <= 0.0) return -driver_.max_deceleration_mps2;
  const double acceleration =
      model_ == FollowingModel::kIidm ? Improved(v, ahead) : Adaptive(v, ahead);
  return std::max(acceleration, -driver_.max_deceleration_mps2);
}

double Following::FreeRoad(double speed_mps) const {
  const double a = driver_.max_acceleration_mps2;
  const double b = driver_.comfortable_deceleration_mps2;
  const double v0 = driver_.desired_speed_mps;
  if (speed_mps <= v0) return a * (1.0 - std::pow(speed_mps / v0, driver_.exponent));
  return -b * (1.0 - std::pow(v0 / speed_mps, a * driver_.exponent / b));
}

double Following::Improved(double speed_mps, const CarAhead& ahead) const {
  const double a = driver_.max_acceleration_mps2;
  const double z = idm_.DesiredGap(speed_mps, ahead.speed_mps) / ahead.gap_m;
  const double free = FreeRoad(speed_mps);
  const bool within = speed_mps <= driver_.desired_speed_mps;
  if (z >= 1.0) return (within ? 0.0 : free) + a * (1.0 - z * z);
  if (!within || free <= 0.0) return free;
  return free * (1.0 - std::pow(z, std::min(2.0 * a / free, kLargestExponent)));
}

double Following::ConstantAccelerationHeuristic(double speed_mps, const CarAhead& ahead) const {
  const double a = std::min(ahead.acceleration_mps2, driver_.max_acceleration_mps2);
  const double s = ahead.gap_m;
  const double lead = ahead.speed_mps;
  const double closing = speed_mps - lead;
  const double denominator = lead * lead - 2.0 * s * a;
  if (lead * closing <= -2.0 * s * a && denominator > 0.0) {
    return speed_mps * speed_mps * a / denominator;  // the car ahead stops before the driver
  }
  const double approach = std::max(closing, 0.0);
  return a - approach * approach / (2.0 * s);
}

double Following::Adaptive(double speed_mps, const CarAhead& ahead) const {
  const double b = driver_.comfortable_deceleration_mps2;
  const double most = -driver_.max_deceleration_mps2;
  const double improved = std::max(Improved(speed_mps, ahead), most);
  const double heuristic = std::max(ConstantAccelerationHeuristic(speed_mps, ahead), most);
  if (improved >= heuristic) return improved;
  const double cool = heuristic + b * std::tanh((improved - heuristic) / b);
  return (1.0 - coolness_) * improved + coolness_ * cool;
}

}  // namespace fogline::models
