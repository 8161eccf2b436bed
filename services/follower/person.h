// A person in a following car: of some temper, with human errors, and perhaps careful in danger.
#pragma once

#include <optional>

#include "scenario/traffic.h"
#include "services/driver_models/fog_sight.h"
#include "services/driver_models/human_driver.h"
#include "services/follower/car_driver.h"
#include "services/follower_models/safety_response.h"
#include "services/follower_models/style.h"

namespace fogline {

/// The IDM with the parameters of his style, seen through the Human Driver Model with its reaction
/// time (services/follower_models/style.h, services/driver_models/human_driver.h). With a safety
/// model on top he takes the smaller of its acceleration and his own; that model does not misjudge,
/// and has a reaction time of its own (services/follower_models/safety_response.h). With sight fog
/// both have what fog leaves of the truth, as the host's driver
/// (services/driver_models/fog_sight.h).
class Person final : public CarDriver {
 public:
  /// @param sight nullopt if he sees perfectly
  /// @param errors the random numbers of his errors, a stream of his own
  /// @throw std::invalid_argument if his reaction time has too many steps (HumanDriver)
  Person(Style style, const std::optional<FogSight>& sight, SafetyModelChoice safety,
         const Random& errors, double step_s);

  Action Step(std::int64_t step, const Situation& now, double visibility_m) override;

 private:
  DriverSection idm_;
  std::optional<FogSight> sight_;
  HumanDriver driver_;
  std::optional<SafetyResponse> safety_;
};

}  // namespace fogline
