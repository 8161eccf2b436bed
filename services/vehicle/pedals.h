// Which of two pedals a demanded force is given to.
#pragma once

namespace fogline {

enum class Pedal { kThrottle, kBrake };

struct PedalDemand {
  double traction_n = 0;  // at least 0
  double brake_n = 0;     // at least 0
};

/// One foot: never both pedals. From the throttle it goes to the brake when the force demanded
/// falls below -band, and back when it rises above band; in between it stays on its pedal, and a
/// demand that this pedal cannot give is not given: the car coasts. So a demand that trembles
/// around 0 by less than the band moves the foot at most once. The price is an error of at most the
/// band, while the demand is within it and on the other side.
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

  /// The foot is where it is before the first demand: on the throttle.
  void Release() { pedal_ = Pedal::kThrottle; }

  Pedal pedal() const { return pedal_; }

 private:
  double band_n_;
  Pedal pedal_ = Pedal::kThrottle;
};

}  // namespace fogline
