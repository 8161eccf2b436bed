// Decides whether the track has recovered after a sensor was deceived.
#pragma once

#include <cstdint>

#include "scenario/sections/scenario.h"
#include "services/graph.h"

namespace fogline::arbitrator {

/// Compares the track with the sensors. The Degree of Conflict is not sufficient for this: it
/// compares only the sensors with each other, over a window of less than a second. The filter has a
/// longer memory. So when the sensors agree again, the filter's track may still be metres away from
/// the values of both sensors. Let d be the track's distance, r_i the range of sensor i, and y_i
/// its lateral offset. A step agrees if there is a track of this step, at least one sensor has a
/// value, and
///
///     |r_i - sqrt(d^2 + y_i^2)| <= hand_back_error_m     for each sensor i that has a value.
class FusionRecovery {
 public:
  explicit FusionRecovery(const Scenario& scenario);

  /// Compares the track and the sensors of one step. Call Observe() once for each step that has
  /// values, in the order of steps.
  void Observe(const radar_t& radar, const lidar_t& lidar, const track_t& track);

  /// Whether all steps of the last hand_back_s have agreed.
  bool recovered() const { return agreeing_steps_ >= required_steps_; }

 private:
  bool Agrees(const radar_t& radar, const lidar_t& lidar, const track_t& track) const;

  double error_m_;
  std::int64_t required_steps_;
  double radar_offset_m_;
  double lidar_offset_m_;
  std::int64_t agreeing_steps_ = 0;  // consecutive steps that agree; at most required_steps_
};

}  // namespace fogline::arbitrator
