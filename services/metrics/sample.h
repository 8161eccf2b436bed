// One step of a run as a flat struct, for measures, reports and exports. A Sample is made from the
// messages of the step. The messages come from a log or from a run in this process.
#pragma once

#include <cstdint>
#include <limits>

#include "services/graph.h"

namespace fogline::metrics {

/// Values of one step in SI units. A field is NaN if it has no value.
struct Sample {
  std::int64_t step = 0;
  double time_s = 0;
  double preceding_speed_mps = 0;
  double preceding_acceleration_mps2 = 0;
  double host_speed_mps = 0;
  double host_acceleration_mps2 = 0;  // applied during the step that ended here
  double host_gap_m = 0;              // true gap
  double host_safe_distance_m = 0;    // d_r of the host's ACC
  double radar_range_m = 0;
  double lidar_range_m = 0;
  double fused_distance_m = 0;
  double follower_speed_mps = 0;
  double follower_acceleration_mps2 = 0;
  double follower_gap_m = 0;            // gap to the host
  double follower_safe_distance_m = 0;  // d_r,f of the car's driver
  double acc_acceleration_mps2 = 0;     // a_A, the offer of the automation
  double driver_acceleration_mps2 = 0;  // a_H, the offer of the driver
  double command_mps2 = 0;              // commanded acceleration for the step that begins here
  double lambda_automation = 1;
  double lambda_human = 0;
  double conflict_m = 0;
  double doc = 0;
  double threshold = 0;
  bool fog_present = false;
  double fog_level = 0;
  double fog_visibility_m = 0;
  std::int8_t collision = 0;
  double collision_time_s = 0;
  bool last = false;
};

/// The sample of a step from its messages. The sample has the values of the first following car
/// only. Without a following car, these values are NaN.
inline Sample MakeSample(const truth_t& truth, const radar_t& radar, const lidar_t& lidar,
                         const track_t& track, const accel_command_t& acc,
                         const driver_command_t& driver, const arbitration_t& host,
                         const follower_command_t& follower) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const bool followed = truth.num_followers > 0;
  const bool commanded = followed && follower.num_followers > 0;
  return {
      .step = truth.header.step,
      .time_s = static_cast<double>(truth.header.utime) * 1e-6,
      .preceding_speed_mps = truth.preceding_speed_mps,
      .preceding_acceleration_mps2 = truth.preceding_acceleration_mps2,
      .host_speed_mps = truth.host_speed_mps,
      .host_acceleration_mps2 = truth.host_acceleration_mps2,
      .host_gap_m = truth.host_gap_m,
      .host_safe_distance_m = acc.safe_distance_m,
      .radar_range_m = radar.valid ? radar.range_m : kNone,
      .lidar_range_m = lidar.valid ? lidar.range_m : kNone,
      .fused_distance_m = track.valid ? track.state[0] : kNone,
      .follower_speed_mps = followed ? truth.follower_speed_mps[0] : kNone,
      .follower_acceleration_mps2 = followed ? truth.follower_acceleration_mps2[0] : kNone,
      .follower_gap_m = followed ? truth.follower_gap_m[0] : kNone,
      .follower_safe_distance_m = commanded ? follower.safe_distance_m[0] : kNone,
      .acc_acceleration_mps2 = acc.acceleration_mps2,
      .driver_acceleration_mps2 = driver.acceleration_mps2,
      .command_mps2 = host.acceleration_mps2,
      .lambda_automation = host.lambda_automation,
      .lambda_human = host.lambda_human,
      .conflict_m = host.conflict_m,
      .doc = host.doc,
      .threshold = host.threshold,
      .fog_present = truth.fog_present != 0,
      .fog_level = truth.fog_level,
      .fog_visibility_m = truth.fog_visibility_m,
      .collision = truth.collision,
      .collision_time_s = truth.collision_time_s,
      .last = truth.last != 0,
  };
}

}  // namespace fogline::metrics
