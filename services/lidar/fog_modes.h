// The modes of a LiDAR in fog, each with its share of the steps. The shares are parameters, not
// results of physics.
#pragma once

#include <cstdint>

#include "scenario/sections/road.h"

namespace fogline::lidar {

/// Kind of the LiDAR's value in one step.
enum class FogMode : std::uint8_t {
  kRight,
  kBiased,    // too short by fog.bias_m
  kNearEcho,  // an echo of the fog in the near field
  kMissing,   // no echo
};

/// With the fog's level l and the target's range r, the probabilities in a step are
///
///     missing    l missing_share m(r)    m(r) = 0 up to missing_from_m,
///                                        1 from missing_beyond_m on, linear between them
///     near echo  l near_echo_share
///     biased     l biased_share
///     right      all other steps
///
/// Steps are independent. With a share of 1, every step at level 1 has this mode (`missing`: only
/// from missing_beyond_m on).
class FogModes {
 public:
  /// @throw InputError if the shares add up to more than 1
  explicit FogModes(const FogModesSection& section);

  /// The mode that belongs to a random number u, uniform in (0, 1).
  FogMode ModeOf(double u, double level, double target_m) const;

  /// m(r), in [0, 1].
  double MissingAt(double target_m) const;

 private:
  FogModesSection section_;
};

}  // namespace fogline::lidar
