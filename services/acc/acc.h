// The automation agent of the host: ACC on the fused track.
#pragma once

#include "fogline/accel_command_t.hpp"
#include "fogline/ego_t.hpp"
#include "fogline/track_t.hpp"
#include "scenario/sections/scenario.h"
#include "services/acc/acc_controller.h"

namespace fogline::acc {

/// The algorithm of the role `acc`. It offers the automation's acceleration a_A in every step, also
/// while the human drives. It uses the host's own odometry and the track of the preceding car,
/// never the truth. It does not decide which side drives. It does not use a track whose distance
/// has a standard deviation above acc.max_track_std_m. A track becomes so uncertain if the sensors
/// give no values.
class Acc {
 public:
  /// @throws InputError if the weights of scenario.acc make an ill-conditioned problem.
  explicit Acc(const Scenario& scenario);

  /// Resets the object to the state of a new Acc(scenario). Restart() is cheaper than a new object
  /// if the ACC's parameters are unchanged.
  void Restart(const Scenario& scenario);

  const accel_command_t& Step(const ego_t& ego, const track_t& track);

 private:
  AccController controller_;
  double max_track_variance_m2_;
  accel_command_t out_{};
};

}  // namespace fogline::acc
