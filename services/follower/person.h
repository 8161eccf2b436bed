// A person who drives a following car, with a style, human errors, and optionally a safety model.
#pragma once

#include <cstdint>
#include <optional>

#include "scenario/sections/traffic.h"
#include "services/follower/driver_action.h"
#include "services/models/aeb/aeb.h"
#include "services/models/driver/fog_sight.h"
#include "services/models/driver/human_driver.h"
#include "services/models/driver/situation.h"
#include "services/models/follower/safety_response.h"
#include "services/models/follower/style.h"

namespace fogline::follower {

/// The model of a person is the Human Driver Model with its errors and reaction time
/// (services/models/driver/human_driver.h). It uses the IDM with the parameters of a driving style
/// (services/models/follower/style.h). With a safety model, the person applies the smaller of two
/// accelerations: the acceleration of the safety model, and the acceleration of the Human Driver
/// Model. The safety model has no errors, and has its own reaction time
/// (services/models/follower/safety_response.h). With sight fog, both models receive only what the
/// person sees in fog, like the host's driver (services/models/driver/fog_sight.h). If the car has
/// emergency braking, the emergency braking receives the same. It has no errors and no reaction
/// time.
class Person {
 public:
  /// @param sight nullopt if the person sees perfectly
  /// @param errors random numbers for the person's errors; each person has a separate stream
  /// @param aeb the emergency braking of the person's car
  /// @throw std::invalid_argument if the reaction time has too many steps (HumanDriver)
  Person(models::Style style, const std::optional<models::FogSight>& sight,
         SafetyModelChoice safety, const Random& errors, double step_s,
         const std::optional<models::Aeb>& aeb = std::nullopt);

  /// The driver's action in this step. Call Step() once per step, in the order of steps.
  /// @param now the truth, with a car ahead
  /// @param visibility_m meteorological optical range
  DriverAction Step(std::int64_t step, const models::Situation& now, double visibility_m);

 private:
  DriverSection idm_;
  std::optional<models::FogSight> sight_;
  models::HumanDriver driver_;
  std::optional<models::SafetyResponse> safety_;
  std::optional<models::Aeb> aeb_;
};

}  // namespace fogline::follower
