// Expected echo powers of target and fog on one beam: the formulas of services/lidar/fog_beam.h
// with the parameters of a scenario. The costly part of the formulas is tabulated.
#pragma once

#include <array>
#include <cstddef>

#include "scenario/sections/sensing.h"
#include "services/lidar/fog_beam.h"

namespace fogline::lidar {

/// Powers of the echoes of target and fog, as ln(P / P_min), where P_min is the detection
/// threshold. An echo above 0 is detected. The value is minus infinity if there is no echo.
struct EchoPowers {
  double target;
  double fog;
  double fog_range_m;  // range at which the fog's echo is strongest
};

class EchoModel {
 public:
  /// Makes the table for extinctions from `from_pm` to `to_pm` in 1/m. At an extinction outside of
  /// this interval, J and r* (fog_beam.h) have the values of the nearer end.
  EchoModel(const LidarBeamSection& beam, double from_pm, double to_pm);

  /// Echoes of a target at `range_m` and of the fog, in air of this visibility (both parameters are
  /// above 0 m):
  ///     P_t / P_min = (Gamma / Gamma_c) (R_c / R)^2 xi(R) exp(-2 alpha R)
  ///     P_f / P_min = (pi beta / Gamma_c) R_c^2 J
  /// R is `range_m`. A target with the reflectivity Gamma_c = clear_reflectivity at the range R_c =
  /// clear_range_m has the power P_min in clear air (LidarBeamSection). fog_beam.h has the other
  /// symbols. A target nearer than r* hides the fog behind it. The fog's echo then lies at R, and J
  /// is multiplied by g(R)/g(r*). Up to the range R1 the beam is blind, so there is no echo.
  EchoPowers At(double range_m, double visibility_m) const;

  /// Power of an echo at `range_m`, relative to the power that the target's echo has in clear air
  /// at this distance. The result is 1 for the target itself in clear air, and a few per mille for
  /// fog.
  double Intensity(double log_power, double range_m) const;

 private:
  // Number of nodes of the table. With this number, linear interpolation has an error of 0.2 % in J
  // and 2 cm in r*, up to the densest fog of scenarios (visibility 5 m).
  static constexpr std::size_t kNodes = 33;

  struct LogPeak {
    double log_strength;  // ln J
    double range_m;       // r*
  };

  double ClearTarget(double range_m) const;  // ln(P_t / P_min) without extinction
  LogPeak PeakAt(double extinction_pm) const;

  BeamOptics optics_;
  double log_target_m2_;    // ln(Gamma / Gamma_c R_c^2)
  double log_backscatter_;  // ln(pi beta V / Gamma_c R_c^2), V: visibility; beta V is constant
  double from_pm_;
  double to_pm_;
  std::array<LogPeak, kNodes> peaks_;  // at equally spaced extinctions
};

}  // namespace fogline::lidar
