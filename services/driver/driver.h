// The human driver of the host: sees the road, or what fog leaves of it, never a sensor. He is
// always at it; whether the host obeys him is the arbitrator's decision.
#pragma once

#include <cstdint>
#include <optional>

#include "scenario/scenario.h"
#include "services/driver_models/awareness.h"
#include "services/driver_models/fog_sight.h"
#include "services/driver_models/following.h"
#include "services/driver_models/human_driver.h"
#include "services/graph.h"

namespace fogline {

/// By default the driver of Sourav & Cheng 2024: the Intelligent Driver Model on the ground truth,
/// perceived perfectly and at once in fog as in clear air, and as ready as the scenario says. Each
/// switch of scenario section `human` takes away some of that (services/driver_models).
class Driver {
 public:
  /// @throws InputError if a step is so short that he cannot remember his reaction time
  explicit Driver(const Scenario& scenario);

  /// One whose awareness depends on who drives has to know that.
  static bool Demands(const Scenario& scenario) { return scenario.human.loses_awareness; }
  /// Who has driven in the step that ends with the next Step().
  void Hear(const arbitration_t& host);

  /// What he would do now. In order; has no memory unless he misjudges or loses awareness. The
  /// result is valid until the next call.
  const driver_command_t& Step(const truth_t& truth);

 private:
  void PassTime(std::int64_t step);
  double Drive(const truth_t& truth);

  Following following_;
  std::optional<FogSight> sight_;
  std::optional<HumanDriver> human_;
  std::optional<Awareness> awareness_;
  HumanParameters errors_;  // of an aware driver
  double step_s_;
  DriverTask task_ = DriverTask::kMonitors;
  std::optional<std::int64_t> last_step_;
  driver_command_t out_{};
};

}  // namespace fogline
