#include "services/world/world.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/core.h>

#include "common/errors.h"
#include "services/graph.h"
#include "services/models/traffic/load_sumo.h"

namespace fogline::world {
namespace {

double Finite(double acceleration_mps2, const char* channel) {
  if (std::isfinite(acceleration_mps2)) return acceleration_mps2;
  throw std::invalid_argument(std::string(channel) + ": acceleration is not finite");
}

models::GradeProfile RoadOf(const Scenario& scenario) {
  try {
    return models::GradeProfile(scenario.road.grade);
  } catch (const std::invalid_argument& error) {
    throw InputError(error.what());
  }
}

// The model of the vehicle; nullopt for a point mass. @param section name of `vehicle` in the
// scenario
std::optional<models::LongitudinalVehicle> VehicleOf(const VehicleSection& vehicle,
                                                     const char* section, const Scenario& scenario,
                                                     const models::GradeProfile& road,
                                                     double step_s) {
  if (vehicle.model == VehicleModel::kPointMass) return std::nullopt;
  try {
    return models::LongitudinalVehicle(models::ParametersOf(vehicle.car),
                                       models::FrictionOf(scenario.road.surface), road, step_s);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("/step_s: {} s is too short for {}: {}", scenario.step_s, section,
                                 error.what()));
  }
}

}  // namespace

World::World(const Scenario& scenario)
    : world_(scenario.world),
      steps_(scenario.steps),
      step_us_(std::llround(scenario.step_s * kMicrosPerSecond)),
      step_s_(static_cast<double>(step_us_) / kMicrosPerSecond),
      leader_(scenario.lead),
      friction_(scenario, RoadOf(scenario)),
      fog_(scenario.fog),
      cars_(kFirstFollower + static_cast<std::size_t>(scenario.followers.count)),
      vehicles_(cars_.size()) {
  MakeVehicles(scenario);
  if (scenario.lead.profile == LeadProfile::kSumo) traffic_ = models::LoadSumo(scenario);
  truth_t& truth = std::get<truth_t>(output_);
  truth.num_followers = static_cast<std::int32_t>(num_followers());
  for (auto* values : {&truth.follower_position_m, &truth.follower_speed_mps,
                       &truth.follower_acceleration_mps2, &truth.follower_gap_m}) {
    values->assign(num_followers(), 0.0);
  }
}

void World::MakeVehicles(const Scenario& scenario) {
  const models::GradeProfile road = RoadOf(scenario);
  vehicles_[kHost] = VehicleOf(scenario.host_vehicle, "/host_vehicle", scenario, road, step_s_);
  const std::optional<models::LongitudinalVehicle> follower =
      VehicleOf(scenario.follower_vehicle, "/follower_vehicle", scenario, road, step_s_);
  std::fill(vehicles_.begin() + kFirstFollower, vehicles_.end(), follower);
}

void World::Prepare() {
  PlaceAll();
  prepared_ = true;
}

const World::Output& World::Start(std::int64_t run_id) {
  if (!prepared_) PlaceAll();
  prepared_ = false;
  run_id_ = run_id;
  step_ = 0;
  collision_ = truth_t::COLLISION_NONE;
  collision_time_s_ = 0.0;
  return Publish();
}

void World::PlaceAll() {
  const double length_m = world_.vehicle_length_m;
  Place(kPreceding, {world_.host_gap_m + length_m, leader_.SpeedAt(0, 0.0)}, 0.0);
  Place(kHost, {0.0, world_.host_speed_mps}, 0.0);
  for (std::size_t i = kFirstFollower; i < cars_.size(); ++i) {
    const double position_m = cars_[i - 1].motion.position_m - (world_.follower_gap_m + length_m);
    Place(i, {position_m, world_.follower_speed_mps}, 0.0);
  }
  if (traffic_) BeginTraffic();
}

void World::BeginTraffic() {
  in_traffic_.clear();
  for (std::size_t i = kHost; i < cars_.size(); ++i) in_traffic_.push_back(cars_[i].motion);
  ahead_ = traffic_->Begin(in_traffic_);
  Place(kPreceding, {ahead_->rear_m + world_.vehicle_length_m, ahead_->speed_mps}, 0.0);
}

void World::End() {
  if (traffic_) traffic_->End();
}

void World::Resume(const truth_t& truth) {
  if (traffic_) {
    throw std::runtime_error(
        "a world with cars from SUMO cannot go on in real time: the state of these cars is lost");
  }
  if (truth.num_followers != static_cast<std::int32_t>(num_followers())) {
    throw std::invalid_argument("TRUTH: " + std::to_string(truth.num_followers) +
                                " following cars instead of " + std::to_string(num_followers()));
  }
  prepared_ = false;
  run_id_ = truth.header.run_id;
  step_ = truth.header.step;
  collision_ = truth.collision;
  collision_time_s_ = truth.collision_time_s;
  Place(kPreceding, {truth.preceding_position_m, truth.preceding_speed_mps},
        truth.preceding_acceleration_mps2);
  Place(kHost, {truth.host_position_m, truth.host_speed_mps}, truth.host_acceleration_mps2);
  for (std::size_t i = 0; i < num_followers(); ++i) {
    Place(kFirstFollower + i, {truth.follower_position_m[i], truth.follower_speed_mps[i]},
          truth.follower_acceleration_mps2[i]);
  }
  Publish();
}

void World::Place(std::size_t car, const models::Motion& motion, double acceleration_mps2) {
  cars_[car] = {.motion = motion,
                .begin_mps = motion.speed_mps,
                .acceleration_mps2 = acceleration_mps2,
                .applied_mps2 = acceleration_mps2};
  if (vehicles_[car]) vehicles_[car]->Begin(motion, acceleration_mps2);
}

const World::Output& World::Step(const arbitration_t& host, const follower_command_t& followers) {
  Command(host, followers);
  Integrate();
  ++step_;
  return Publish();
}

double World::TimeOf(std::int64_t step) const {
  return static_cast<double>(step * step_us_) / kMicrosPerSecond;
}

double World::GapOf(std::size_t car) const {
  return cars_[car - 1].motion.position_m - world_.vehicle_length_m - cars_[car].motion.position_m;
}

void World::Command(const arbitration_t& host, const follower_command_t& followers) {
  if (followers.num_followers != static_cast<std::int32_t>(num_followers()) ||
      followers.acceleration_mps2.size() != num_followers()) {
    throw std::invalid_argument("FOLLOWER_COMMAND: " + std::to_string(followers.num_followers) +
                                " accelerations for " + std::to_string(num_followers()) +
                                " following cars");
  }
  Obey(kHost, Finite(host.acceleration_mps2, "HOST_COMMAND"));
  for (std::size_t i = 0; i < num_followers(); ++i) {
    Obey(kFirstFollower + i, Finite(followers.acceleration_mps2[i], "FOLLOWER_COMMAND"));
  }
  traffic_ ? FollowTraffic() : Lead();
}

void World::Lead() {
  const models::Motion& now = cars_[kPreceding].motion;
  const double next_mps = leader_.SpeedAt(step_ + 1, TimeOf(step_ + 1));
  const double profile_mps2 = (next_mps - now.speed_mps) / step_s_;
  const double possible_mps2 = friction_.Limited(profile_mps2, now.position_m);
  profile_mps_.reset();
  if (possible_mps2 == profile_mps2) profile_mps_ = next_mps;
  Obey(kPreceding, possible_mps2);
}

void World::FollowTraffic() {
  for (std::size_t i = kHost; i < cars_.size(); ++i) {
    in_traffic_[i - kHost] = models::Advance(cars_[i].motion, cars_[i].acceleration_mps2, step_s_);
  }
  ahead_ = traffic_->Step(in_traffic_);
  // The preceding car keeps its speed during this step in two cases: at the end of the step a
  // different car is ahead of the host, or the lane is empty.
  const bool same = ahead_ && !ahead_->changed;
  const double change_mps = same ? ahead_->speed_mps - cars_[kPreceding].motion.speed_mps : 0.0;
  Obey(kPreceding, change_mps / step_s_);
}

// Places the preceding car exactly where SUMO has it, so that the rounding of the integration has
// no effect.
void World::PlaceByTraffic() {
  Car& preceding = cars_[kPreceding];
  preceding.motion = {ahead_->rear_m + world_.vehicle_length_m, ahead_->speed_mps};
  if (ahead_->changed) preceding.applied_mps2 = ahead_->acceleration_mps2;
}

void World::Obey(std::size_t car, double command_mps2) {
  Car& moved = cars_[car];
  std::optional<models::LongitudinalVehicle>& vehicle = vehicles_[car];
  moved.begin_mps = moved.motion.speed_mps;
  moved.acceleration_mps2 = vehicle ? vehicle->Step(command_mps2, moved.motion) : command_mps2;
}

void World::Integrate() {
  const double substep_s = step_s_ / static_cast<double>(world_.substeps);
  for (std::int64_t i = 0; i < world_.substeps; ++i) {
    if (collision_ == truth_t::COLLISION_NONE) {
      RecordCollision(TimeOf(step_) + static_cast<double>(i) * substep_s, substep_s);
    }
    for (Car& car : cars_)
      car.motion = models::Advance(car.motion, car.acceleration_mps2, substep_s);
  }
  // Use the exact speed of the profile, because v + a t has a rounding error.
  if (profile_mps_) cars_[kPreceding].motion.speed_mps = *profile_mps_;

  for (Car& car : cars_) {
    const bool rested = car.acceleration_mps2 < 0.0 && car.motion.speed_mps == 0.0;
    car.applied_mps2 = rested ? (0.0 - car.begin_mps) / step_s_ : car.acceleration_mps2;
  }
  if (ahead_) PlaceByTraffic();
}

void World::RecordCollision(double begin_s, double duration_s) {
  double first_s = duration_s;
  for (std::size_t i = kHost; i < cars_.size(); ++i) {
    const Car& ahead = cars_[i - 1];
    const Car& behind = cars_[i];
    const std::optional<double> contact_s =
        models::TimeToContact(GapOf(i), ahead.motion.speed_mps, ahead.acceleration_mps2,
                              behind.motion.speed_mps, behind.acceleration_mps2, duration_s);
    const bool first = contact_s && (collision_ == truth_t::COLLISION_NONE || *contact_s < first_s);
    if (!first) continue;
    first_s = *contact_s;
    collision_ = i == kHost ? truth_t::COLLISION_HOST : truth_t::COLLISION_FOLLOWER;
    collision_time_s_ = begin_s + first_s;
  }
}

const World::Output& World::Publish() {
  auto& [truth, ego] = output_;
  truth.header.run_id = run_id_;
  truth.header.step = step_;
  truth.header.utime = step_ * step_us_;

  const Car& preceding = cars_[kPreceding];
  truth.preceding_position_m = preceding.motion.position_m;
  truth.preceding_speed_mps = preceding.motion.speed_mps;
  truth.preceding_acceleration_mps2 = preceding.applied_mps2;
  const Car& host = cars_[kHost];
  truth.host_position_m = host.motion.position_m;
  truth.host_speed_mps = host.motion.speed_mps;
  truth.host_acceleration_mps2 = host.applied_mps2;
  truth.host_gap_m = GapOf(kHost);
  for (std::size_t i = 0; i < num_followers(); ++i) {
    const Car& follower = cars_[kFirstFollower + i];
    truth.follower_position_m[i] = follower.motion.position_m;
    truth.follower_speed_mps[i] = follower.motion.speed_mps;
    truth.follower_acceleration_mps2[i] = follower.applied_mps2;
    truth.follower_gap_m[i] = GapOf(kFirstFollower + i);
  }

  const Fog fog = fog_.At(truth.header.utime);
  truth.fog_present = fog.present;
  truth.fog_level = fog.level;
  truth.fog_visibility_m = fog.visibility_m;
  truth.collision = collision_;
  truth.collision_time_s = collision_time_s_;
  const bool crashed = collision_ != truth_t::COLLISION_NONE && world_.end_on_collision;
  truth.last = crashed || step_ == steps_ - 1;

  if (truth.last) End();

  ego.header = truth.header;
  ego.speed_mps = truth.host_speed_mps;
  ego.acceleration_mps2 = truth.host_acceleration_mps2;
  return output_;
}

}  // namespace fogline::world
