// The automation agent of the host: ACC on the fused track.
#pragma once

#include "fogline/accel_command_t.hpp"
#include "fogline/ego_t.hpp"
#include "fogline/track_t.hpp"
#include "scenario/sections/scenario.h"
#include "services/acc/acc_controller.h"

namespace fogline::acc {

/// Offers the automation's acceleration a_A in every step, also while the human drives. The ACC
/// uses the host's own odometry and the track of the preceding car, never the truth. The ACC does
/// not decide about authority. A track that has become too uncertain, because the sensors gave no
/// values, is not used.
class Acc {
 public:
  /// @throws InputError if the weights of scenario.acc make an ill-conditioned problem.
  explicit Acc(const Scenario& scenario);

  /// Resets the object to the state of a new Acc(scenario). Restart() is cheaper than a new object
  /// if the ACC's parameters are equal.
  void Restart(const Scenario& scenario);

  const accel_command_t& Step(const ego_t& ego, const track_t& track);

 private:
  AccController controller_;
  double max_track_variance_m2_;
  accel_command_t out_{};
};

}  // namespace fogline::acc
