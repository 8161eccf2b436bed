// For tests: the messages of a step, and a function that passes them to the arbitrator.
#pragma once

#include "services/arbitrator/arbitrator.h"
#include "tests/unit/services/arbitrator/two_commands.h"

namespace fogline {

struct Messages {
  ego_t ego{};
  radar_t radar{};
  lidar_t lidar{};
  track_t track{};
  accel_command_t automation{};
  driver_command_t driver{};
};

/// Messages in which radar and LiDAR have this difference (radar - LiDAR).
inline Messages Differing(double difference_m) {
  Messages m;
  m.radar.valid = 1;
  m.radar.range_m = 32 + difference_m;
  m.lidar.valid = 1;
  m.lidar.range_m = 32;
  m.automation.acceleration_mps2 = kAutomation_mps2;
  m.driver.acceleration_mps2 = kHuman_mps2;
  return m;
}

/// @return the command; valid until the next step
inline const arbitration_t& Step(arbitrator::Arbitrator& arbitrator, const Messages& m) {
  return arbitrator.Step(m.ego, m.radar, m.lidar, m.track, m.automation, m.driver);
}

}  // namespace fogline
