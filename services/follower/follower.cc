#include "services/follower/follower.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "services/follower/driver_assignment.h"

namespace fogline::follower {
namespace {

Person MakePerson(const Scenario& scenario, std::size_t car, models::Style style) {
  const Random errors(scenario.seed, FollowerErrors(static_cast<std::uint32_t>(car)));
  std::optional<models::FogSight> sight;
  if (scenario.followers.sight == Sight::kFog) sight.emplace(scenario.human.fog_sight);
  try {
    return {style,  sight,           scenario.followers.safety_model,
            errors, scenario.step_s, AebOf(scenario.followers)};
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("/step_s: {} s is too short for a person in following car {}: {}",
                                 scenario.step_s, car, error.what()));
  }
}

/// The driver of this car. If this driver and `before` are both ACCs, the result is `before` after
/// a Restart(). Otherwise the result is a new object. @param before may be nullptr
CarDriver MakeDriver(const Scenario& scenario, std::size_t car, CarDriver* before) {
  const DriverAssignment assignment = AssignmentOf(scenario, car);
  if (!assignment.has_acc) return MakePerson(scenario, car, assignment.style);
  auto* acc = before == nullptr ? nullptr : std::get_if<AccDriver>(before);
  if (acc == nullptr) return AccDriver(scenario);
  acc->Restart(scenario);
  return std::move(*acc);
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
  std::vector<CarDriver> before = std::exchange(drivers_, {});
  const auto cars = static_cast<std::size_t>(scenario.followers.count);
  drivers_.reserve(cars);
  for (std::size_t car = 0; car < cars; ++car) {
    drivers_.push_back(MakeDriver(scenario, car, car < before.size() ? &before[car] : nullptr));
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
    const models::Situation now = SituationOf(truth, car);
    auto* person = std::get_if<Person>(&drivers_[car]);
    const DriverAction action = person != nullptr
                                    ? person->Step(truth.header.step, now, truth.fog_visibility_m)
                                    : std::get<AccDriver>(drivers_[car]).Step(now);
    out_.acceleration_mps2.push_back(action.acceleration_mps2);
    out_.safe_distance_m.push_back(action.safe_distance_m);
  }
  return out_;
}

}  // namespace fogline::follower
