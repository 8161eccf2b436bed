// Speed of the preceding car over time: the stimulus of the experiment. It reacts to nobody.
#pragma once

#include <cstdint>
#include <vector>

#include "scenario/road.h"

namespace fogline {

/// The preceding car's speed profile.
class Leader {
 public:
  /// @throw std::invalid_argument if the profile is `recorded` and no speeds are there.
  explicit Leader(const LeadSection& lead);

  /// Speed in m/s at a step, `time_s` after the start; never negative. Profile `recorded` goes by
  /// the step, the others by the time; each goes on beyond its end with its last speed.
  double SpeedAt(std::int64_t step, double time_s) const;

 private:
  double BreakpointSpeed(double time_s) const;
  double SinusoidSpeed(double time_s) const;
  double EmergencyBrakeSpeed(double time_s) const;
  double RecordedSpeed(std::int64_t step) const;

  LeadSection lead_;
  std::vector<double> ends_s_;  // of each breakpoint, counted from the start
};

}  // namespace fogline
