#include "services/metrics/gaps/holes.h"

#include <limits>

namespace fogline::metrics {
namespace {

/// A sample without values, one step after `before`.
Sample Hole(const Sample& before, double step_s) {
  Sample hole{.step = before.step + 1, .time_s = before.time_s + step_s};
  for (double Sample::*field : {&Sample::preceding_speed_mps,
                                &Sample::preceding_acceleration_mps2,
                                &Sample::host_speed_mps,
                                &Sample::host_acceleration_mps2,
                                &Sample::host_gap_m,
                                &Sample::host_safe_distance_m,
                                &Sample::radar_range_m,
                                &Sample::lidar_range_m,
                                &Sample::fused_distance_m,
                                &Sample::follower_speed_mps,
                                &Sample::follower_acceleration_mps2,
                                &Sample::follower_gap_m,
                                &Sample::follower_safe_distance_m,
                                &Sample::acc_acceleration_mps2,
                                &Sample::driver_acceleration_mps2,
                                &Sample::command_mps2,
                                &Sample::lambda_automation,
                                &Sample::lambda_human,
                                &Sample::conflict_m,
                                &Sample::doc,
                                &Sample::threshold,
                                &Sample::fog_level,
                                &Sample::fog_visibility_m}) {
    hole.*field = std::numeric_limits<double>::quiet_NaN();
  }
  return hole;
}

}  // namespace

std::vector<Sample> WithHoles(const std::vector<Sample>& samples, double step_s) {
  std::vector<Sample> all;
  for (const Sample& sample : samples) {
    if (!all.empty() && sample.step > all.back().step + 1) all.push_back(Hole(all.back(), step_s));
    all.push_back(sample);
  }
  return all;
}

}  // namespace fogline::metrics
