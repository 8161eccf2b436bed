#include "services/world/vehicle_fallback.h"

#include <algorithm>

namespace fogline::world {
namespace {

// Whether the driver has taken over. In the step in which a driver ends a manoeuvre, emergency
// braking may replace the mode RECOVERING. Then only the authority of the human shows that the
// driver has taken over.
bool DriverHasTakenOver(const arbitration_t& command) {
  return command.mode == arbitration_t::RECOVERING ||
         (command.mode == arbitration_t::EMERGENCY_BRAKING && HumanIsEngaged(command.lambda_human));
}

}  // namespace

double CarFallback::Step(InputState state, std::optional<double> command_mps2, double speed_mps,
                         double applied_mps2) {
  if (state == InputState::kLost) minimal_risk_.Begin(applied_mps2);
  if (minimal_risk_.begun()) return minimal_risk_.Step(speed_mps);
  if (Usable(state) && command_mps2) last_mps2_ = command_mps2;
  if (!last_mps2_) last_mps2_ = applied_mps2;
  return *last_mps2_;
}

VehicleFallback::VehicleFallback(const Scenario& scenario)
    : health_(scenario.health),
      host_(scenario.minimal_risk, scenario.step_s),
      followers_(static_cast<std::size_t>(scenario.followers.count),
                 {.fallback = CarFallback(scenario.minimal_risk, scenario.step_s)}) {
  host_out_.lambda_automation = 1;
  followers_out_.num_followers = static_cast<std::int32_t>(followers_.size());
  followers_out_.acceleration_mps2.assign(followers_.size(), 0.0);
  followers_out_.safe_distance_m.assign(followers_.size(), 0.0);
}

void VehicleFallback::Step(const truth_t& now, const Heard<arbitration_t>& host,
                           const Heard<follower_command_t>& followers) {
  StepHost(now, host);
  followers_out_.header = now.header;
  follower_state_ = followers.state;
  for (std::size_t car = 0; car < followers_.size(); ++car) StepFollower(car, now, followers);
}

void VehicleFallback::ResumeFollowers(const truth_t& now) {
  for (std::size_t car = 0; car < followers_.size(); ++car) {
    followers_[car].fallback.BeginMinimalRisk(now.follower_acceleration_mps2.at(car));
  }
}

bool VehicleFallback::follower_in_minimal_risk() const {
  return std::ranges::any_of(
      followers_, [](const FollowingCar& car) { return car.fallback.in_minimal_risk(); });
}

void VehicleFallback::StepHost(const truth_t& now, const Heard<arbitration_t>& host) {
  if (Usable(host.state)) {
    const std::int8_t mode = host.newest->mode;
    const bool stops = InMinimalRisk(mode);
    if (DriverHasTakenOver(*host.newest) && !IsLocked(host_out_.mode)) commanded_ = false;
    if (commanded_ && !stops) host_.BeginMinimalRisk(now.host_acceleration_mps2);
    if (stops) commanded_ = true;
    host_out_ = *host.newest;
  }
  host_out_.header = now.header;
  host_out_.acceleration_mps2 = host_.Step(
      host.state, Usable(host.state) ? std::optional(host.newest->acceleration_mps2) : std::nullopt,
      now.host_speed_mps, now.host_acceleration_mps2);
  if (host_.in_minimal_risk()) {
    host_out_.mode = arbitration_t::MINIMAL_RISK;
    host_out_.lambda_automation = 0;
    host_out_.lambda_human = 0;
  }
}

// A message without an acceleration for this car counts as missing for this car. If such messages
// counted as commands, the state of the car's input would stay OK, although no command comes.
void VehicleFallback::StepFollower(std::size_t car, const truth_t& now,
                                   const Heard<follower_command_t>& followers) {
  FollowingCar& follower = followers_[car];
  InputState state = followers.state;
  std::optional<double> command_mps2;
  if (Usable(followers.state)) {
    const bool empty = followers.newest->num_followers <= static_cast<std::int64_t>(car);
    follower.empty_steps = empty ? follower.empty_steps + 1 : 0;
    if (empty) {
      state = std::max(state, StateAfter(follower.empty_steps));
    } else {
      command_mps2 = followers.newest->acceleration_mps2[car];
      followers_out_.safe_distance_m[car] = followers.newest->safe_distance_m[car];
    }
  }
  follower_state_ = std::max(follower_state_, state);
  followers_out_.acceleration_mps2[car] = follower.fallback.Step(
      state, command_mps2, now.follower_speed_mps.at(car), now.follower_acceleration_mps2.at(car));
}

// `steps` is the number of consecutive messages without an acceleration for the car. At the first
// such message, the last command is two periods old.
InputState VehicleFallback::StateAfter(std::int64_t steps) const {
  const double age = static_cast<double>(steps) + 1;
  if (age > std::max(health_.stale_periods, health_.lost_periods)) return InputState::kLost;
  return age > health_.stale_periods ? InputState::kStale : InputState::kOk;
}

}  // namespace fogline::world
