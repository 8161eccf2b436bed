// Whether the track has recovered from a deceived sensor.
#pragma once

#include <cstdint>

#include "scenario/sections/scenario.h"
#include "services/graph.h"

namespace fogline::arbitrator {

/// The Degree of Conflict compares the sensors with each other, over a window of less than a
/// second. The filter has a longer memory. When the sensors agree again, the filter's track may
/// still be metres away from both sensors. This class compares the track with the sensors. With d
/// the track's distance, r_i the range of sensor i and y_i its lateral offset, a step agrees if
///
///     |r_i - sqrt(d^2 + y_i^2)| <= hand_back_error_m     for each sensor i that has a value,
///
/// if at least one sensor has a value, and if there is a track of the same step.
class FusionRecovery {
 public:
  explicit FusionRecovery(const Scenario& scenario);

  /// Call it for each step that has values, in order.
  void Observe(const radar_t& radar, const lidar_t& lidar, const track_t& track);

  /// Whether the last steps have agreed for at least hand_back_s, without a break.
  bool recovered() const { return agreeing_steps_ >= required_steps_; }

 private:
  bool Agrees(const radar_t& radar, const lidar_t& lidar, const track_t& track) const;

  double error_m_;
  std::int64_t required_steps_;
  double radar_offset_m_;
  double lidar_offset_m_;
  std::int64_t agreeing_steps_ = 0;  // without a break; at most required_steps_
};

}  // namespace fogline::arbitrator
