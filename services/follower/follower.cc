#include "services/follower/follower.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include <fmt/core.h>

#include "common/errors.h"
#include "services/follower/acc_driver.h"
#include "services/follower/driver_assignment.h"
#include "services/follower/person.h"

namespace fogline::follower {
namespace {

std::unique_ptr<CarDriver> MakePerson(const Scenario& scenario, std::size_t car,
                                      models::Style style) {
  const Random errors(scenario.seed, FollowerErrors(static_cast<std::uint32_t>(car)));
  std::optional<models::FogSight> sight;
  if (scenario.followers.sight == Sight::kFog) sight.emplace(scenario.human.fog_sight);
  try {
    return std::make_unique<Person>(style, sight, scenario.followers.safety_model, errors,
                                    scenario.step_s, AebOf(scenario.followers));
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("/step_s: {} s is too short for a person in following car {}: {}",
                                 scenario.step_s, car, error.what()));
  }
}

/// The driver of this car. If this driver and `before` are both ACCs, the result is `before`,
/// restarted. Otherwise the result is a new object.
std::unique_ptr<CarDriver> MakeDriver(const Scenario& scenario, std::size_t car,
                                      std::unique_ptr<CarDriver> before) {
  const DriverAssignment assignment = AssignmentOf(scenario, car);
  if (!assignment.has_acc) return MakePerson(scenario, car, assignment.style);
  if (auto* acc = dynamic_cast<AccDriver*>(before.get())) {
    acc->Restart(scenario);
    return before;
  }
  return std::make_unique<AccDriver>(scenario);
}

/// The true situation of this following car.
models::Situation SituationOf(const truth_t& truth, std::size_t car) {
  const bool first = car == 0;
  return {.speed_mps = truth.follower_speed_mps[car],
          .acceleration_mps2 = truth.follower_acceleration_mps2[car],
          .ahead = models::CarAhead{
              .gap_m = truth.follower_gap_m[car],
              .speed_mps = first ? truth.host_speed_mps : truth.follower_speed_mps[car - 1],
              .acceleration_mps2 = first ? truth.host_acceleration_mps2
                                         : truth.follower_acceleration_mps2[car - 1]}};
}

}  // namespace

void Follower::Restart(const Scenario& scenario) {
  drivers_.resize(static_cast<std::size_t>(scenario.followers.count));
  for (std::size_t car = 0; car < drivers_.size(); ++car) {
    drivers_[car] = MakeDriver(scenario, car, std::move(drivers_[car]));
  }
  out_.acceleration_mps2.reserve(drivers_.size());
  out_.safe_distance_m.reserve(drivers_.size());
}

const follower_command_t& Follower::Step(const truth_t& truth) {
  const std::size_t cars =
      std::min(drivers_.size(), static_cast<std::size_t>(std::max(truth.num_followers, 0)));
  out_.header = truth.header;
  out_.num_followers = static_cast<std::int32_t>(cars);
  out_.acceleration_mps2.clear();
  out_.safe_distance_m.clear();
  for (std::size_t car = 0; car < cars; ++car) {
    const CarDriver::Action action =
        drivers_[car]->Step(truth.header.step, SituationOf(truth, car), truth.fog_visibility_m);
    out_.acceleration_mps2.push_back(action.acceleration_mps2);
    out_.safe_distance_m.push_back(action.safe_distance_m);
  }
  return out_;
}

}  // namespace fogline::follower
