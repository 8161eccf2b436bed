// The host's LiDAR. In each step, the LiDAR measures the distance of the preceding car, or has no
// value. The LiDAR does not track or filter, and cannot distinguish an echo of the fog from an echo
// of the car.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/random.h"
#include "fogline/lidar_t.hpp"
#include "fogline/truth_t.hpp"
#include "scenario/sections/scenario.h"
#include "services/lidar/echo_model.h"
#include "services/lidar/fog_modes.h"
#include "services/normal_draws.h"

namespace fogline::lidar {

/// With the gap x and the lateral offset y, the target is at r = sqrt(x^2 + y^2). The LiDAR reports
/// range = d + bias + noise, where the noise is Gaussian and white. The scenario's fog model gives
/// d:
///     none   d = r
///     bias   d = r - fog.bias_m * fog level              (Sourav & Cheng 2024)
///     beam   d = median over the beams' echoes           (services/lidar/fog_beam.h)
///     modes  d = r, or r - fog.bias_m, or an echo of the fog, or no value, each in a share of the
///            steps                                       (services/lidar/fog_modes.h)
/// On each beam the echo powers of target and fog are lognormal and independent. The stronger of
/// these two echoes is the beam's echo if its power exceeds the detection threshold. The fog's echo
/// lies behind r* (fog_beam.h) by fog_range_scale_m times a random number with the distribution
/// Beta(2, 20), but never behind the target. At least half of the beams must have an echo. So, for
/// any odd number of beams, the range at which the LiDAR detects with probability 1/2 is the same
/// as for a single beam. A minority of the beams cannot determine the result.
class Lidar {
 public:
  /// Indices of the random numbers of stream kLidar within a step.
  static constexpr std::uint32_t kNoiseDraw = 0;        // Normal2: range, second unused
  static constexpr std::uint32_t kDropoutDraw = 1;      // Uniform2: first number, second unused
  static constexpr std::uint32_t kModeDraw = 2;         // Uniform2: first number, second unused
  static constexpr std::uint32_t kModeScatterDraw = 3;  // Uniform2: scatter of a near echo
  /// Indices of the random numbers of stream kLidarBeam within a step, for beam n, counted from 0.
  static constexpr std::uint32_t PowerDraw(std::uint32_t n) { return 2 * n; }  // target, fog
  static constexpr std::uint32_t ScatterDraw(std::uint32_t n) { return 2 * n + 1; }

  /// @throw InputError if the shares of fog model modes add up to more than 1
  explicit Lidar(const Scenario& scenario);

  /// Resets the object to the state of a new Lidar(scenario). If the seed is unchanged, the object
  /// may keep the random numbers of its noise, so the next run is cheaper than with a new object.
  void Restart(const Scenario& scenario);

  /// The measurement in the step of `truth`. The measurement depends only on scenario and truth,
  /// not on earlier steps.
  const lidar_t& Step(const truth_t& truth);

 private:
  // Echo on one beam. The order is total, so that the median is unique.
  struct BeamEcho {
    double range_m;
    double log_power;  // ln(P / P_min)
    auto operator<=>(const BeamEcho&) const = default;
  };
  // Result from all beams.
  struct Echo {
    double range_m;
    double range_std_m;
    double intensity;
  };

  bool DropsOut(std::int64_t step) const;
  std::optional<Echo> PlainEcho(const truth_t& truth, double target_m) const;
  std::optional<Echo> PlainEchoAt(double target_m, double bias_m) const;
  std::optional<Echo> MedianEcho(const truth_t& truth, double target_m);
  std::optional<Echo> ModalEcho(const truth_t& truth, double target_m) const;
  Echo NearEcho(const truth_t& truth, double target_m) const;
  void CollectEchoes(const truth_t& truth, double target_m);

  LidarSection lidar_;
  double fog_bias_m_;  // bias at level 1, or in a biased step; 0 for fog models none and beam
  Random random_;
  NormalDraws noise_;
  Random beam_random_;
  std::optional<EchoModel> model_;  // for the fog models beam and modes
  std::optional<FogModes> modes_;   // for fog model modes
  std::vector<BeamEcho> echoes_;
  lidar_t output_{};
};

}  // namespace fogline::lidar
