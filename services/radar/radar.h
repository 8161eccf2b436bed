// The host's radar. In each step, the radar measures the distance of the preceding car, and the
// rate of this distance. The radar does not track or filter, and measures only one target.
#pragma once

#include <cstdint>

#include "common/random.h"
#include "fogline/radar_t.hpp"
#include "fogline/truth_t.hpp"
#include "scenario/sections/scenario.h"
#include "services/normal_draws.h"

namespace fogline::radar {

/// x is the gap, x' its rate, and y the lateral offset. A target at r = sqrt(x^2 + y^2) is measured
/// as
///     range = r + bias + noise,   range rate = x x' / r + noise
/// where noise is Gaussian and white. The radar has no value for a target beyond the maximum range,
/// and no value in a step with a dropout. Rain shortens the maximum range. With the fog models beam
/// and modes, fog also shortens the maximum range. With the fog models none and bias, fog has no
/// effect on the radar, as in the paper (Sourav & Cheng 2024).
class Radar {
 public:
  /// Indices of the random numbers of stream kRadar within a step.
  static constexpr std::uint32_t kNoiseDraw = 0;    // Normal2: range, range rate
  static constexpr std::uint32_t kDropoutDraw = 1;  // Uniform2: first number, second unused

  explicit Radar(const Scenario& scenario);

  /// Resets the object to the state of a new Radar(scenario). If the seed is unchanged, the object
  /// may keep the random numbers of its noise, so the next run is cheaper than with a new object.
  void Restart(const Scenario& scenario);

  /// The measurement in the step of `truth`. The measurement depends only on scenario and truth,
  /// not on earlier steps.
  const radar_t& Step(const truth_t& truth);

 private:
  double MaxRange(const truth_t& truth) const;
  bool DropsOut(std::int64_t step) const;

  RadarSection radar_;
  Random random_;
  NormalDraws noise_;
  bool fog_attenuates_;
  double fog_coefficient_;  // K_l, (dB/km) / (g/m3)
  double rain_dbpkm_;
  double rainy_max_range_m_;
  radar_t output_{};
};

}  // namespace fogline::radar
