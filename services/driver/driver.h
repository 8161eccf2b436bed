// The human driver of the host: sees the true gap and speeds, never a sensor. He is always at it;
// whether the host obeys him is the arbitrator's decision.
#pragma once

#include "scenario/scenario.h"
#include "services/driver/idm.h"
#include "services/graph.h"

namespace fogline {

/// Intelligent Driver Model (idm.h) on the ground truth, with perfect and immediate perception in
/// fog as in clear air: the driver of Sourav & Cheng 2024. His readiness is the scenario's.
class Driver {
 public:
  explicit Driver(const Scenario& scenario);

  /// What he would do now. Has no memory. The result is valid until the next call.
  const driver_command_t& Step(const truth_t& truth);

 private:
  Idm idm_;
  driver_command_t out_{};
};

}  // namespace fogline
