// A following car with the ACC of Sourav & Cheng 2024.
#pragma once

#include "services/acc/acc_controller.h"
#include "services/follower/car_driver.h"

namespace fogline {

/// The same ACC as the host's (services/acc), with parameters of its own and with perfect sensors.
class AccDriver final : public CarDriver {
 public:
  /// @throws InputError if the section's weights make no well-conditioned problem.
  AccDriver(const AccSection& section, double step_s) : controller_(section, step_s) {}

  /// Begins anew, as a new one would; cheaper where its parameters are the same.
  /// @throws as the constructor
  void Restart(const AccSection& section, double step_s) { controller_.Restart(section, step_s); }

  Action Step(std::int64_t step, const Situation& now) override;

 private:
  AccController controller_;
};

}  // namespace fogline
