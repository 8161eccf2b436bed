#include "services/arbitrator/arbitrator.h"

namespace fogline {

Arbitrator::Arbitrator(const Scenario& scenario)
    : section_(scenario.arbitrator),
      window_(static_cast<std::size_t>(scenario.arbitrator.window_steps)) {
  out_.threshold = section_.threshold;
}

const arbitration_t& Arbitrator::Step(const ego_t& ego, const radar_t& radar, const lidar_t& lidar,
                                      const track_t& /*track*/, const accel_command_t& automation,
                                      const driver_command_t& driver) {
  Observe(radar, lidar);
  return Choose(ego.header, automation, driver);
}

void Arbitrator::Observe(const radar_t& radar, const lidar_t& lidar) {
  window_.Push(Difference(radar, lidar));
}

const arbitration_t& Arbitrator::Choose(const header_t& header, const accel_command_t& automation,
                                        const driver_command_t& driver) {
  out_.header = header;
  out_.conflict_m = window_.Conflict(section_.conflict);
  out_.doc = DegreeOfConflict(out_.conflict_m, section_.doc_slope_per_m, section_.doc_centre_m);
  const bool human = section_.policy == Policy::kTraded && !(out_.doc < section_.threshold);
  out_.lambda_automation = human ? 0 : 1;
  out_.lambda_human = 1 - out_.lambda_automation;
  // With authorities of 0 and 1 the printed sum is a choice. Made as a choice it passes the offer
  // on bit by bit, and whatever the other one is.
  out_.acceleration_mps2 = human ? driver.acceleration_mps2 : automation.acceleration_mps2;
  out_.mode = human ? arbitration_t::HUMAN : arbitration_t::AUTOMATION;
  return out_;
}

// What this step counts as in the window.
std::optional<double> Arbitrator::Difference(const radar_t& radar, const lidar_t& lidar) {
  if (radar.valid && lidar.valid) return last_difference_m_ = radar.range_m - lidar.range_m;
  switch (section_.missing_lidar) {
    case MissingLidar::kHold:
      return last_difference_m_;  // none before the first one
    case MissingLidar::kSkip:
      return std::nullopt;
    case MissingLidar::kConflict:
      return section_.missing_conflict_m;
  }
  return std::nullopt;
}

}  // namespace fogline
