#include "services/world/leader.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace fogline::world {

Leader::Leader(const LeadSection& lead) : lead_(lead) {
  if (lead_.profile == LeadProfile::kRecorded && lead_.recorded.speeds_mps.empty()) {
    throw std::invalid_argument(
        "/lead/recorded/speeds_mps is empty: profile recorded needs a speed for step 0 at least");
  }
  double end_s = 0.0;
  ends_s_.reserve(lead_.breakpoints.size());
  for (const SpeedBreakpoint& breakpoint : lead_.breakpoints) {
    end_s += breakpoint.duration_s;
    ends_s_.push_back(end_s);
  }
}

double Leader::SpeedAt(std::int64_t step, double time_s) const {
  switch (lead_.profile) {
    case LeadProfile::kConstant:
    case LeadProfile::kSumo:
      return lead_.speed_mps;
    case LeadProfile::kBreakpoints:
      return BreakpointSpeed(time_s);
    case LeadProfile::kSinusoid:
      return SinusoidSpeed(time_s);
    case LeadProfile::kEmergencyBrake:
      return EmergencyBrakeSpeed(time_s);
    case LeadProfile::kRecorded:
      return RecordedSpeed(step);
  }
  return lead_.speed_mps;
}

double Leader::BreakpointSpeed(double time_s) const {
  const auto end = std::upper_bound(ends_s_.begin(), ends_s_.end(), time_s);
  const auto i = static_cast<std::size_t>(end - ends_s_.begin());
  const double from = i == 0 ? lead_.speed_mps : lead_.breakpoints[i - 1].speed_mps;
  if (end == ends_s_.end()) return from;
  const SpeedBreakpoint& next = lead_.breakpoints[i];
  const double left = (*end - time_s) / next.duration_s;  // in (0, 1]
  return next.speed_mps + std::min(left, 1.0) * (from - next.speed_mps);
}

double Leader::SinusoidSpeed(double time_s) const {
  const SinusoidSection& sine = lead_.sinusoid;
  if (time_s < sine.start_s) return lead_.speed_mps;
  const double phase = 2.0 * std::numbers::pi * (time_s - sine.start_s) / sine.period_s;
  return std::max(0.0, lead_.speed_mps + sine.amplitude_mps * std::sin(phase));
}

double Leader::EmergencyBrakeSpeed(double time_s) const {
  const EmergencyBrakeSection& brake = lead_.emergency_brake;
  if (time_s < brake.start_s) return lead_.speed_mps;
  // A car that is already slower than the final speed keeps its speed.
  const double final_speed_mps = std::min(brake.final_speed_mps, lead_.speed_mps);
  const double speed_mps = lead_.speed_mps - brake.deceleration_mps2 * (time_s - brake.start_s);
  return std::max(final_speed_mps, speed_mps);
}

double Leader::RecordedSpeed(std::int64_t step) const {
  const std::vector<double>& speeds_mps = lead_.recorded.speeds_mps;
  return speeds_mps[std::min(static_cast<std::size_t>(step), speeds_mps.size() - 1)];
}

}  // namespace fogline::world
