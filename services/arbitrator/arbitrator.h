// Decides who drives the host, in every step anew: the automation, or the human driver while the
// sensors disagree. It judges neither offer; what it passes on is one of the two, unchanged.
#pragma once

#include <optional>

#include "scenario/scenario.h"
#include "services/arbitrator/conflict.h"
#include "services/graph.h"

namespace fogline {

/// Traded control of Sourav & Cheng 2024:
///
///     lambda_A = 1 if 0 <= DoC < threshold, else 0        lambda_H = 1 - lambda_A
///     a = lambda_H a_H + lambda_A a_A
///
/// with the Degree of Conflict of conflict.h. Under policy `automation` lambda_A is 1 throughout,
/// and the DoC is there to look at.
class Arbitrator {
 public:
  explicit Arbitrator(const Scenario& scenario);

  /// The host's command for the step that begins here. Once per step, in order. Only the sensors
  /// and the two offers decide; ego and track are there for policies that weigh more than conflict.
  /// The result is valid until the next call.
  const arbitration_t& Step(const ego_t& ego, const radar_t& radar, const lidar_t& lidar,
                            const track_t& track, const accel_command_t& automation,
                            const driver_command_t& driver);

  /// The two halves of a Step: the sensors' values take their place in the window, ...
  void Observe(const radar_t& radar, const lidar_t& lidar);
  /// ... and what the window holds decides between the offers. In real time a step may be decided
  /// without new values of the sensors.
  const arbitration_t& Choose(const header_t& header, const accel_command_t& automation,
                              const driver_command_t& driver);

 private:
  std::optional<double> Difference(const radar_t& radar, const lidar_t& lidar);

  ArbitratorSection section_;
  ConflictWindow window_;
  std::optional<double> last_difference_m_;  // of the last step with both values
  arbitration_t out_{};
};

}  // namespace fogline
