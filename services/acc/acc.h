// The automation agent of the host: ACC on the fused track.
#pragma once

#include "fogline/accel_command_t.hpp"
#include "fogline/ego_t.hpp"
#include "fogline/track_t.hpp"
#include "scenario/scenario.h"
#include "services/acc/acc_controller.h"

namespace fogline {

/// Offers the automation's acceleration a_A in every step, whoever drives. Sees the host's own
/// odometry and the track of the preceding car, never the truth; decides nothing about authority.
/// A track that has become too uncertain, because the sensors have been silent, counts as none.
class Acc {
 public:
  /// @throws InputError if the weights of scenario.acc make no well-conditioned problem.
  explicit Acc(const Scenario& scenario);

  /// Begins anew, as Acc(scenario) would; cheaper where the ACC's parameters are the same.
  void Restart(const Scenario& scenario);

  const accel_command_t& Step(const ego_t& ego, const track_t& track);

 private:
  AccController controller_;
  double max_track_variance_m2_;
  accel_command_t out_{};
};

}  // namespace fogline
