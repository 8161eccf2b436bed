// A following car with the ACC of Sourav & Cheng 2024.
#pragma once

#include "scenario/scenario.h"
#include "services/acc/acc_controller.h"
#include "services/follower/car_driver.h"

namespace fogline {

/// The same ACC as the host's (services/acc), with parameters of its own and with perfect sensors.
class AccDriver final : public CarDriver {
 public:
  /// @throws InputError if the section's weights make no well-conditioned problem.
  explicit AccDriver(const Scenario& scenario)
      : controller_(scenario.follower, scenario.step_s, scenario.follower_vehicle.model) {}

  /// Begins anew, as a new one would; cheaper where its parameters are the same.
  /// @throws as the constructor
  void Restart(const Scenario& scenario) {
    controller_.Restart(scenario.follower, scenario.step_s, scenario.follower_vehicle.model);
  }

  Action Step(std::int64_t step, const Situation& now, double visibility_m) override;

 private:
  AccController controller_;
};

}  // namespace fogline
