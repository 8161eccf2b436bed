// Exact motion of a car along the lane under a constant acceleration, and the time at which two
// cars touch.
#pragma once

#include <optional>

namespace fogline::models {

/// Position and speed of a car; the speed is never negative.
struct Motion {
  double position_m = 0;
  double speed_mps = 0;
};

/// Time in s after which a car of this speed comes to rest; infinite if the car does not come to
/// rest.
double TimeToRest(double speed_mps, double acceleration_mps2);

/// Motion after `duration_s`: x + v t + a t^2 / 2 and v + a t. A braking car that comes to rest
/// earlier stays at x + v^2 / (2 |a|) with speed 0, because cars do not roll backwards.
Motion Advance(const Motion& from, double acceleration_mps2, double duration_s);

/// First time in [0, duration_s] at which the gap between two cars is closed; nullopt if the gap
/// stays open; 0 if the gap is closed at the beginning. Each car keeps its acceleration until it
/// rests. Between the moments at which a car comes to rest, the gap is a parabola, whose first root
/// has a closed form.
std::optional<double> TimeToContact(double gap_m, double ahead_speed_mps,
                                    double ahead_acceleration_mps2, double behind_speed_mps,
                                    double behind_acceleration_mps2, double duration_s);

}  // namespace fogline::models
