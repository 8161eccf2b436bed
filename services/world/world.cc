#include "services/world/world.h"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

namespace fogline {
namespace {

constexpr double kMicrosPerSecond = 1e6;
constexpr std::int32_t kNumFollowers = 1;

double Finite(double acceleration_mps2, const char* channel) {
  if (std::isfinite(acceleration_mps2)) return acceleration_mps2;
  throw std::invalid_argument(std::string(channel) + ": acceleration is not finite");
}

}  // namespace

World::World(const Scenario& scenario)
    : world_(scenario.world),
      steps_(scenario.steps),
      step_us_(std::llround(scenario.step_s * kMicrosPerSecond)),
      step_s_(static_cast<double>(step_us_) / kMicrosPerSecond),
      leader_(scenario.lead),
      fog_(scenario.fog) {
  truth_t& truth = std::get<truth_t>(output_);
  truth.num_followers = kNumFollowers;
  for (auto* values : {&truth.follower_position_m, &truth.follower_speed_mps,
                       &truth.follower_acceleration_mps2, &truth.follower_gap_m}) {
    values->assign(kNumFollowers, 0.0);
  }
}

const World::Output& World::Start(std::int64_t run_id) {
  run_id_ = run_id;
  step_ = 0;
  collision_ = truth_t::COLLISION_NONE;
  collision_time_s_ = 0.0;
  const double length_m = world_.vehicle_length_m;
  cars_[kPreceding] = {.motion = {world_.host_gap_m + length_m, leader_.SpeedAt(0, 0.0)}};
  cars_[kHost] = {.motion = {0.0, world_.host_speed_mps}};
  cars_[kFollower] = {.motion = {-world_.follower_gap_m - length_m, world_.follower_speed_mps}};
  return Publish();
}

void World::Resume(const truth_t& truth) {
  if (truth.num_followers != kNumFollowers) {
    throw std::invalid_argument("TRUTH: " + std::to_string(truth.num_followers) +
                                " following cars instead of " + std::to_string(kNumFollowers));
  }
  run_id_ = truth.header.run_id;
  step_ = truth.header.step;
  collision_ = truth.collision;
  collision_time_s_ = truth.collision_time_s;
  const auto car = [](double position_m, double speed_mps, double acceleration_mps2) {
    return Car{.motion = {position_m, speed_mps},
               .command_mps2 = acceleration_mps2,
               .applied_mps2 = acceleration_mps2};
  };
  cars_[kPreceding] =
      car(truth.preceding_position_m, truth.preceding_speed_mps, truth.preceding_acceleration_mps2);
  cars_[kHost] = car(truth.host_position_m, truth.host_speed_mps, truth.host_acceleration_mps2);
  cars_[kFollower] = car(truth.follower_position_m[0], truth.follower_speed_mps[0],
                         truth.follower_acceleration_mps2[0]);
  Publish();
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
  if (followers.num_followers != kNumFollowers ||
      followers.acceleration_mps2.size() != kNumFollowers) {
    throw std::invalid_argument("FOLLOWER_COMMAND: " + std::to_string(followers.num_followers) +
                                " accelerations for " + std::to_string(kNumFollowers) +
                                " following car");
  }
  const double next_mps = leader_.SpeedAt(step_ + 1, TimeOf(step_ + 1));
  cars_[kPreceding].command_mps2 = (next_mps - cars_[kPreceding].motion.speed_mps) / step_s_;
  cars_[kHost].command_mps2 = Finite(host.acceleration_mps2, "HOST_COMMAND");
  cars_[kFollower].command_mps2 = Finite(followers.acceleration_mps2[0], "FOLLOWER_COMMAND");
}

void World::Integrate() {
  std::array<double, kNumCars> begin_mps;
  for (std::size_t i = 0; i < kNumCars; ++i) begin_mps[i] = cars_[i].motion.speed_mps;

  const double substep_s = step_s_ / static_cast<double>(world_.substeps);
  for (std::int64_t i = 0; i < world_.substeps; ++i) {
    if (collision_ == truth_t::COLLISION_NONE) {
      RecordCollision(TimeOf(step_) + static_cast<double>(i) * substep_s, substep_s);
    }
    for (Car& car : cars_) car.motion = Advance(car.motion, car.command_mps2, substep_s);
  }
  // The profile itself, free of what the sum v + a t rounds away.
  cars_[kPreceding].motion.speed_mps = leader_.SpeedAt(step_ + 1, TimeOf(step_ + 1));

  for (std::size_t i = 0; i < kNumCars; ++i) {
    Car& car = cars_[i];
    const bool rested = car.command_mps2 < 0.0 && car.motion.speed_mps == 0.0;
    car.applied_mps2 = rested ? (0.0 - begin_mps[i]) / step_s_ : car.command_mps2;
  }
}

void World::RecordCollision(double begin_s, double duration_s) {
  double first_s = duration_s;
  for (std::size_t i = kHost; i < kNumCars; ++i) {
    const Car& ahead = cars_[i - 1];
    const Car& behind = cars_[i];
    const std::optional<double> contact_s =
        TimeToContact(GapOf(i), ahead.motion.speed_mps, ahead.command_mps2, behind.motion.speed_mps,
                      behind.command_mps2, duration_s);
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
  const Car& follower = cars_[kFollower];
  truth.follower_position_m[0] = follower.motion.position_m;
  truth.follower_speed_mps[0] = follower.motion.speed_mps;
  truth.follower_acceleration_mps2[0] = follower.applied_mps2;
  truth.follower_gap_m[0] = GapOf(kFollower);

  const Fog fog = fog_.At(truth.header.utime);
  truth.fog_present = fog.present;
  truth.fog_level = fog.level;
  truth.fog_visibility_m = fog.visibility_m;
  truth.collision = collision_;
  truth.collision_time_s = collision_time_s_;
  const bool crashed = collision_ != truth_t::COLLISION_NONE && world_.end_on_collision;
  truth.last = crashed || step_ == steps_ - 1;

  ego.header = truth.header;
  ego.speed_mps = truth.host_speed_mps;
  ego.acceleration_mps2 = truth.host_acceleration_mps2;
  return output_;
}

}  // namespace fogline
