// The acceleration that a person wants, from the travel of the pedals.
#pragma once

#include <algorithm>
#include <cmath>

#include "scenario/sections/person.h"

namespace fogline::models {

/// The pedal map of a scenario. With throttle t and brake b, each from 0 (released) to 1 (full),
/// and the scenario's full throttle A, full brake B and coasting c:
///
///     a_H = A f(t) - c (1 - f(t)) - B f(b), at least -B
///     f(x) = x with map linear, x^pedal_exponent with map progressive
///
/// So full throttle gives A, released pedals give -c, and full brake gives -B. If both pedals are
/// pressed, both have an effect.
class PedalResponse {
 public:
  explicit PedalResponse(const PersonSection& person) : person_(person) {}

  /// @param throttle, brake a value outside [0, 1] counts as the nearer limit
  /// @return m/s2
  double Acceleration(double throttle, double brake) const {
    const double drive = Share(throttle);
    const double wanted = person_.full_throttle_mps2 * drive - person_.coasting_mps2 * (1 - drive) -
                          person_.full_brake_mps2 * Share(brake);
    return std::max(wanted, -person_.full_brake_mps2);
  }

  /// Whether the travel of a pedal has reached the threshold for taking over.
  bool TakesOver(double throttle, double brake) const {
    return std::max(throttle, brake) >= person_.take_over_pedal;
  }

 private:
  double Share(double travel) const {
    const double x = std::clamp(travel, 0.0, 1.0);
    return person_.pedal_map == PedalMap::kLinear ? x : std::pow(x, person_.pedal_exponent);
  }

  PersonSection person_;
};

}  // namespace fogline::models
