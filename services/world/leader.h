// Speed of the preceding car over time. This speed is the stimulus of the experiment. The preceding
// car does not react to other cars.
#pragma once

#include <cstdint>
#include <vector>

#include "scenario/sections/road.h"

namespace fogline::world {

/// The preceding car's speed profile. For profile sumo, the speeds come from
/// services/models/traffic instead.
class Leader {
 public:
  /// @throw std::invalid_argument if the profile is `recorded` and there are no speeds.
  explicit Leader(const LeadSection& lead);

  /// Speed in m/s at this step; never negative. The step is at `time_s` after the start of the run.
  /// Profile `recorded` uses `step`, the other profiles use `time_s`. After the end of a profile,
  /// the car keeps the profile's last speed.
  double SpeedAt(std::int64_t step, double time_s) const;

 private:
  double BreakpointSpeed(double time_s) const;
  double SinusoidSpeed(double time_s) const;
  double EmergencyBrakeSpeed(double time_s) const;
  double RecordedSpeed(std::int64_t step) const;

  LeadSection lead_;
  std::vector<double> ends_s_;  // end time of each breakpoint, from the start of the run
};

}  // namespace fogline::world
