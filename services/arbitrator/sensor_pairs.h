// Radar and LiDAR of one and the same step, in real time, where either may come late or not at all.
// The difference of values of two steps would take the car's own motion for a conflict: at a
// closing speed of 10 m/s a step of 0.1 s makes 1 m, which is the centre of the DoC.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "scenario/realtime.h"
#include "services/graph.h"
#include "services/runtime/input_state.h"

namespace fogline {

/// The newest pair, and its health by the same limits as any input's, in steps instead of time.
class SensorPairs {
 public:
  explicit SensorPairs(const HealthSection& section);

  /// Takes the newest message of each sensor, nullptr if none has come; what is known already
  /// changes nothing. Once per decision.
  /// @param step at which the arbitrator decides
  /// @return the health of the pair
  InputState Update(std::int64_t step, const radar_t* radar, const lidar_t* lidar);

  bool has_pair() const { return pair_step_ >= 0; }
  /// The step of the newest pair, -1 if there is none.
  std::int64_t newest() const { return pair_step_; }
  /// The newest pair. @pre has_pair()
  const radar_t& radar() const { return radar_; }
  const lidar_t& lidar() const { return lidar_; }

 private:
  // A sensor may be so many steps behind the other, less one; as much as is LOST by default.
  static constexpr std::size_t kDepth = 4;

  void Match();
  void Judge(std::int64_t step);

  HealthSection section_;
  // The last messages of each, by step modulo kDepth; step -1: none.
  std::array<radar_t, kDepth> radars_{};
  std::array<lidar_t, kDepth> lidars_{};
  std::int64_t pair_step_ = -1;
  radar_t radar_{};
  lidar_t lidar_{};

  InputState state_ = InputState::kAwaited;
  std::int64_t began_ = -1;   // first decision
  std::int64_t in_time_ = 0;  // decisions without interruption whose pair was in time
};

}  // namespace fogline
