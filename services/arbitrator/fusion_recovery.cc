#include "services/arbitrator/fusion_recovery.h"

#include <algorithm>
#include <cmath>

#include "common/whole_steps.h"

namespace fogline::arbitrator {

FusionRecovery::FusionRecovery(const Scenario& scenario)
    : error_m_(scenario.arbitrator.transfer.hand_back_error_m),
      required_steps_(StepsUntil(scenario.arbitrator.transfer.hand_back_s, scenario.step_s)),
      radar_offset_m_(scenario.radar.lateral_offset_m),
      lidar_offset_m_(scenario.lidar.lateral_offset_m) {}

void FusionRecovery::Observe(const radar_t& radar, const lidar_t& lidar, const track_t& track) {
  agreeing_steps_ =
      Agrees(radar, lidar, track) ? std::min(agreeing_steps_ + 1, required_steps_) : 0;
}

bool FusionRecovery::Agrees(const radar_t& radar, const lidar_t& lidar,
                            const track_t& track) const {
  const bool compares =
      track.valid && track.header.step == radar.header.step && (radar.valid || lidar.valid);
  if (!compares) return false;
  const double distance_m = track.state[0];
  const auto near = [&](double range_m, double offset_m) {
    return std::abs(range_m - std::sqrt(distance_m * distance_m + offset_m * offset_m)) <= error_m_;
  };
  return (!radar.valid || near(radar.range_m, radar_offset_m_)) &&
         (!lidar.valid || near(lidar.range_m, lidar_offset_m_));
}

}  // namespace fogline::arbitrator
