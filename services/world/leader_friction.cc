#include "services/world/leader_friction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"
#include "services/models/vehicle/longitudinal_vehicle.h"
#include "services/models/vehicle/vehicle_parameters.h"

namespace fogline::world {
namespace {

// Tolerance for the rounding of speeds and their differences, m/s2.
constexpr double kRounding_mps2 = 1e-9;

double StrongestBraking(double friction, double grade) {
  const double cosine = 1.0 / std::sqrt(1.0 + grade * grade);
  return std::max(0.0, models::kGravity_mps2 * (friction + grade) * cosine);
}

// The limit at the steepest rise of the road. For grades of at most 0.3, as in a scenario, the
// limit grows with the grade.
double StrongestAnywhere(const RoadSection& road, double friction) {
  double steepest = road.grade.empty() ? 0.0 : road.grade.front().grade;
  for (const GradePoint& point : road.grade) steepest = std::max(steepest, point.grade);
  return StrongestBraking(friction, steepest);
}

// A braking that a profile states, with the field that states it and the text about its value.
struct StatedBraking {
  double braking_mps2 = 0;
  std::string field;
  std::string value;
};

StatedBraking HardestBreakpoint(const LeadSection& lead) {
  StatedBraking hardest;
  double from_mps = lead.speed_mps;
  for (std::size_t i = 0; i < lead.breakpoints.size(); ++i) {
    const SpeedBreakpoint& to = lead.breakpoints[i];
    const double braking_mps2 = (from_mps - to.speed_mps) / to.duration_s;
    if (braking_mps2 > hardest.braking_mps2) {
      hardest = {braking_mps2, fmt::format("/lead/breakpoints/{}/speed_mps", i),
                 fmt::format("{} m/s, {} s after {} m/s, is a braking of {:.3f} m/s2",
                             NumberText(to.speed_mps), NumberText(to.duration_s),
                             NumberText(from_mps), braking_mps2)};
    }
    from_mps = to.speed_mps;
  }
  return hardest;
}

StatedBraking HardestStated(const LeadSection& lead) {
  switch (lead.profile) {
    case LeadProfile::kConstant:
    case LeadProfile::kRecorded:  // the braking of a recording is known only step by step
    case LeadProfile::kSumo:      // SUMO's own vehicle types state the braking of its cars
      break;
    case LeadProfile::kBreakpoints:
      return HardestBreakpoint(lead);
    case LeadProfile::kSinusoid: {
      const SinusoidSection& sine = lead.sinusoid;
      const double braking_mps2 = 2.0 * std::numbers::pi * sine.amplitude_mps / sine.period_s;
      return {braking_mps2, "/lead/sinusoid/amplitude_mps",
              fmt::format("{} m/s within a period of {} s is a braking of up to {:.3f} m/s2",
                          NumberText(sine.amplitude_mps), NumberText(sine.period_s), braking_mps2)};
    }
    case LeadProfile::kEmergencyBrake: {
      const EmergencyBrakeSection& brake = lead.emergency_brake;
      if (brake.final_speed_mps >= lead.speed_mps) break;  // the car does not brake
      return {brake.deceleration_mps2, "/lead/emergency_brake/deceleration_mps2",
              fmt::format("{} m/s2", NumberText(brake.deceleration_mps2))};
    }
  }
  return {};
}

}  // namespace

LeaderFriction::LeaderFriction(const Scenario& scenario, models::GradeProfile road)
    : has_tyres_(scenario.host_vehicle.model == VehicleModel::kLongitudinal ||
                 scenario.follower_vehicle.model == VehicleModel::kLongitudinal),
      friction_(models::FrictionOf(scenario.road.surface)),
      road_(std::move(road)) {
  if (!has_tyres_) return;
  const double limit_mps2 = StrongestAnywhere(scenario.road, friction_);
  const StatedBraking stated = HardestStated(scenario.lead);
  if (stated.braking_mps2 <= limit_mps2 + kRounding_mps2) return;
  const auto surface = static_cast<std::size_t>(scenario.road.surface);
  throw InputError(
      fmt::format("{}: {}; no tyre on this road brakes harder than {:.3f} m/s2 (/road/surface is "
                  "\"{}\", friction {})",
                  stated.field, stated.value, limit_mps2, ChoiceNames<Surface>::kNames[surface],
                  NumberText(friction_)));
}

double LeaderFriction::Limited(double profile_mps2, double position_m) const {
  if (!has_tyres_ || profile_mps2 >= 0) return profile_mps2;
  const double limit_mps2 = StrongestBraking(friction_, road_.GradeAt(position_m));
  return profile_mps2 < -limit_mps2 - kRounding_mps2 ? -limit_mps2 : profile_mps2;
}

}  // namespace fogline::world
