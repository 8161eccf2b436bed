#include "services/models/vehicle/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fogline::models {
namespace {

// Smallest t >= 0 with gap + rate t + curvature t^2 / 2 = 0, where gap is above 0. The result is
// infinite if there is no such t. Of two equivalent formulas for the root, the function uses the
// formula that adds numbers of the same sign. So there is no cancellation.
double FirstRoot(double gap, double rate, double curvature) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double discriminant = rate * rate - 2.0 * curvature * gap;
  if (discriminant < 0.0) return kNever;
  const double root = std::sqrt(discriminant);
  if (rate < 0.0) return 2.0 * gap / (root - rate);
  return curvature < 0.0 ? (rate + root) / -curvature : kNever;
}

}  // namespace

double TimeToRest(double speed_mps, double acceleration_mps2) {
  return acceleration_mps2 < 0.0 ? speed_mps / -acceleration_mps2
                                 : std::numeric_limits<double>::infinity();
}

Motion Advance(const Motion& from, double acceleration_mps2, double duration_s) {
  const double v = from.speed_mps;
  const double a = acceleration_mps2;
  if (TimeToRest(v, a) <= duration_s) return {from.position_m + v * v / (-2.0 * a), 0.0};
  return {from.position_m + (v + 0.5 * a * duration_s) * duration_s,
          std::max(0.0, v + a * duration_s)};
}

std::optional<double> TimeToContact(double gap_m, double ahead_speed_mps,
                                    double ahead_acceleration_mps2, double behind_speed_mps,
                                    double behind_acceleration_mps2, double duration_s) {
  // In most cases the gap is longer than the distance that the car behind can drive within
  // duration_s, so there is no contact. The factor 2 covers rounding.
  const double fastest_mps =
      behind_speed_mps + std::max(0.0, behind_acceleration_mps2) * duration_s;
  if (gap_m > 2.0 * fastest_mps * duration_s) return std::nullopt;
  const double ahead_rests = TimeToRest(ahead_speed_mps, ahead_acceleration_mps2);
  const double behind_rests = TimeToRest(behind_speed_mps, behind_acceleration_mps2);
  double now = 0.0;
  double gap = gap_m;
  Motion ahead{0.0, ahead_speed_mps};
  Motion behind{0.0, behind_speed_mps};
  while (gap > 0.0) {
    // Both accelerations are constant until the next moment at which a car comes to rest.
    double end = duration_s;
    if (ahead_rests > now) end = std::min(end, ahead_rests);
    if (behind_rests > now) end = std::min(end, behind_rests);
    const double a = ahead_rests > now ? ahead_acceleration_mps2 : 0.0;
    const double b = behind_rests > now ? behind_acceleration_mps2 : 0.0;
    const double root = FirstRoot(gap, ahead.speed_mps - behind.speed_mps, a - b);
    if (now + root <= end) return now + root;
    if (end >= duration_s) return std::nullopt;
    ahead = Advance(ahead, a, end - now);
    behind = Advance(behind, b, end - now);
    gap = gap_m + ahead.position_m - behind.position_m;
    now = end;
  }
  return now;
}

}  // namespace fogline::models
