// The world in real time. In every step it moves the cars with the commands that have come. A car
// whose command is missing follows the fallback of vehicle_fallback.h.
#pragma once

#include <cstdint>
#include <string>

#include "services/input_state.h"
#include "services/world/vehicle_fallback.h"
#include "services/world/world.h"

namespace fogline::world {

/// All inputs of the world. Each input has its newest message if a message has come.
struct WorldInputs {
  Heard<arbitration_t> host;
  Heard<follower_command_t> followers;
};

class FailsafeWorld {
 public:
  using Output = World::Output;

  explicit FailsafeWorld(const Scenario& scenario) : world_(scenario), vehicles_(scenario) {}

  void Prepare() { world_.Prepare(); }
  const Output& Start(std::int64_t run_id) { return world_.Start(run_id); }
  /// Continues the run after a step that an earlier process published.
  /// @param minimal_risk cars that were in the minimal risk manoeuvre (bits of status_t), and stay
  ///     in it
  void Resume(const truth_t& truth, std::int8_t minimal_risk);
  /// The next step.
  const Output& Step(const WorldInputs& inputs);

  /// Text that describes the fallback of the cars whose commands are late or missing; "" if there
  /// is no fallback.
  const std::string& fallback() const { return fallback_; }
  /// The cars that are in a minimal risk manoeuvre, as bits of status_t.
  std::int8_t minimal_risk() const;

 private:
  void Describe(const WorldInputs& inputs);

  World world_;
  VehicleFallback vehicles_;
  std::string fallback_;
};

}  // namespace fogline::world
