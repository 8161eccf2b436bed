// The automation agent of the host: ACC on the fused track.
#pragma once

#include "fogline/accel_command_t.hpp"
#include "fogline/ego_t.hpp"
#include "fogline/track_t.hpp"
#include "scenario/sections/scenario.h"
#include "services/acc/acc_controller.h"

namespace fogline::acc {

/// The algorithm of the role `acc`. The ACC offers the automation's acceleration a_A in every step,
/// even while the human drives. The ACC uses the host's own odometry and the track of the preceding
/// car, never the truth. The ACC does not decide which side drives. The ACC does not use a track if
/// the standard deviation of its distance is above acc.max_track_std_m. If the sensors give no
/// values for some time, the standard deviation grows above this limit.
class Acc {
 public:
  /// @throws InputError if the weights of scenario.acc make an ill-conditioned problem.
  explicit Acc(const Scenario& scenario);

  /// Resets the object to the state of a new Acc(scenario). If the ACC's parameters are unchanged,
  /// Restart() is cheaper than a new object.
  void Restart(const Scenario& scenario);

  const accel_command_t& Step(const ego_t& ego, const track_t& track);

 private:
  AccController controller_;
  double max_track_variance_m2_;
  accel_command_t out_{};
};

}  // namespace fogline::acc
