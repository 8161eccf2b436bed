// The human driver of the host. The driver sees the road as far as fog allows, and does not use the
// sensors. The driver offers an acceleration in every step. The arbitrator decides whether the host
// follows this offer. In real time a person at pedals may take the place of this model.
#pragma once

#include <cstdint>
#include <optional>

#include "scenario/sections/scenario.h"
#include "services/graph.h"
#include "services/models/driver/awareness.h"
#include "services/models/driver/fog_sight.h"
#include "services/models/driver/following.h"
#include "services/models/driver/human_driver.h"
#include "services/models/driver/pedal_response.h"

namespace fogline::driver {

/// The algorithm of the role `driver`. By default, it is the driver of Sourav & Cheng 2024: the
/// Intelligent Driver Model on the ground truth. The driver perceives the truth perfectly and
/// without delay, also in fog. The scenario sets the readiness. Each switch in the scenario's
/// section `human` replaces a part of this driver by a more realistic model
/// (services/models/driver).
class Driver {
 public:
  /// @throws InputError if a step is so short that the reaction time is more than 254 steps
  explicit Driver(const Scenario& scenario);

  /// Whether the driver needs HOST_COMMAND, because the awareness depends on which side drives.
  static bool UsesOnDemandInput(const Scenario& scenario) {
    return scenario.human.loses_awareness && !scenario.person.drives;
  }
  /// Takes the host's command of the previous step. The mode of this command says which side drove.
  void SetOnDemandInput(const arbitration_t& host);

  /// Whether a person drives. SetLiveInput() is then called before every Step().
  static bool UsesLiveInput(const Scenario& scenario) { return scenario.person.drives; }
  /// Takes the input of the person; nullptr if no person is there. The next offer is a function of
  /// this input alone (services/models/driver/pedal_response.h). If no person is there, the pedals
  /// are released, and the readiness is 0.
  void SetLiveInput(const driver_input_t* input);

  /// The acceleration that the driver offers. Call Step() in the order of steps. The result depends
  /// on earlier steps only if `misjudges` or `loses_awareness` of the section `human` is on. The
  /// result is valid until the next call.
  const driver_command_t& Step(const truth_t& truth);

 private:
  bool Acknowledges(const driver_input_t& input) const;
  void PassTime(std::int64_t step);
  double Drive(const truth_t& truth);

  models::Following following_;
  std::optional<models::FogSight> sight_;
  std::optional<models::HumanDriver> human_;
  std::optional<models::Awareness> awareness_;
  HumanParameters errors_;  // errors of an aware driver
  PersonSection person_;
  models::PedalResponse pedals_;
  double readiness_;  // readiness of a person who drives
  double step_s_;
  models::DriverTask task_ = models::DriverTask::kMonitors;
  std::optional<std::int64_t> last_step_;
  driver_command_t out_{};
};

}  // namespace fogline::driver
