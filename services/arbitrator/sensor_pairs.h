// Pairs of radar and LiDAR values of the same step. In real time, one of the two values may come
// late or not at all. If the arbitrator compared values of two different steps, relative motion
// would count as conflict. At a closing speed of 10 m/s the range changes by 1 m in a step of
// 0.1 s. With the default of `doc_centre_m` the DoC is 1/2 at a difference of 1 m. So this false
// difference alone could cause a transfer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "scenario/sections/realtime.h"
#include "services/graph.h"
#include "services/input_state.h"

namespace fogline::arbitrator {

/// The newest pair of radar and LiDAR values, and the state of this pair (OK, STALE, ...). The
/// state depends on the age of the pair. HealthSection gives the limits for this age, in periods.
/// One period is one step here.
class SensorPairs {
 public:
  explicit SensorPairs(const HealthSection& section);

  /// Takes the newest message of each sensor; nullptr if no message has come. A message that was
  /// already taken has no effect. Call Update() once per decision.
  /// @param step at which the arbitrator decides
  /// @return the state of the pair
  InputState Update(std::int64_t step, const radar_t* radar, const lidar_t* lidar);

  bool has_pair() const { return pair_step_ >= 0; }
  /// The step of the newest pair; -1 if there is no pair.
  std::int64_t newest() const { return pair_step_; }
  /// The newest pair. @pre has_pair()
  const radar_t& radar() const { return radar_; }
  const lidar_t& lidar() const { return lidar_; }

 private:
  // A sensor may be kDepth - 1 steps behind the other sensor. With the default limits, a pair of
  // this age is LOST.
  static constexpr std::size_t kDepth = 4;

  void Match();
  void Judge(std::int64_t step);

  HealthSection section_;
  // The last messages of each sensor, at index step modulo kDepth; an empty place has step -1.
  std::array<radar_t, kDepth> radars_{};
  std::array<lidar_t, kDepth> lidars_{};
  std::int64_t pair_step_ = -1;
  radar_t radar_{};
  lidar_t lidar_{};

  InputState state_ = InputState::kAwaited;
  std::int64_t began_ = -1;   // step of the first decision
  std::int64_t in_time_ = 0;  // consecutive decisions with a pair that is young enough for OK
};

}  // namespace fogline::arbitrator
