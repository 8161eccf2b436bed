// Splits a demanded force between two pedals.
#pragma once

namespace fogline::models {

enum class Pedal { kThrottle, kBrake };

struct PedalDemand {
  double traction_n = 0;  // at least 0
  double brake_n = 0;     // at least 0
};

/// The pedals of a driver with one foot, which uses only one pedal at a time. The foot goes from
/// the throttle to the brake when the demanded force falls below -band. The foot goes back when the
/// force rises above band. Between these limits, the foot stays on its pedal. If this pedal cannot
/// give the demanded force, the car coasts. So a demand that changes its sign, but stays within the
/// band, does not move the foot. While the car coasts in this way, the error of the force is at
/// most the band.
class Pedals {
 public:
  /// @param band_n at least 0
  explicit Pedals(double band_n) : band_n_(band_n) {}

  /// @param force_n positive forwards
  PedalDemand Split(double force_n) {
    if (force_n < -band_n_) pedal_ = Pedal::kBrake;
    if (force_n > band_n_) pedal_ = Pedal::kThrottle;
    if (pedal_ == Pedal::kThrottle) return {.traction_n = force_n > 0.0 ? force_n : 0.0};
    return {.brake_n = force_n < 0.0 ? -force_n : 0.0};
  }

  /// Puts the foot on the throttle, as before the first demand.
  void Release() { pedal_ = Pedal::kThrottle; }

  Pedal pedal() const { return pedal_; }

 private:
  double band_n_;
  Pedal pedal_ = Pedal::kThrottle;
};

}  // namespace fogline::models
