// A following car with the ACC of Sourav & Cheng 2024.
#pragma once

#include <optional>

#include "scenario/sections/scenario.h"
#include "services/acc/acc_controller.h"
#include "services/follower/driver_action.h"
#include "services/models/aeb/aeb.h"
#include "services/models/driver/situation.h"

namespace fogline::follower {

/// The same ACC as in the host (services/acc), with its own parameters and with perfect sensors. If
/// the car has emergency braking, the emergency braking uses the same sensors.
class AccDriver {
 public:
  /// @throws InputError if the section's weights make an ill-conditioned problem.
  explicit AccDriver(const Scenario& scenario)
      : controller_(scenario.follower, scenario.step_s, scenario.follower_vehicle.model),
        aeb_(AebOf(scenario.followers)) {}

  /// Resets the object to the state of a new AccDriver(scenario). If the ACC's parameters are
  /// unchanged, Restart() is cheaper than a new object.
  /// @throws the exceptions of the constructor
  void Restart(const Scenario& scenario) {
    controller_.Restart(scenario.follower, scenario.step_s, scenario.follower_vehicle.model);
    aeb_ = AebOf(scenario.followers);
  }

  /// The driver's action in this step. @param now the truth, with a car ahead
  DriverAction Step(const models::Situation& now);

 private:
  acc::AccController controller_;
  std::optional<models::Aeb> aeb_;
};

}  // namespace fogline::follower
