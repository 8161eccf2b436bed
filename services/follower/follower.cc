#include "services/follower/follower.h"

namespace fogline {

Follower::Follower(const Scenario& scenario) : controller_(scenario.follower, scenario.step_s) {
  out_.acceleration_mps2.reserve(1);
  out_.safe_distance_m.reserve(1);
}

const follower_command_t& Follower::Step(const truth_t& truth) {
  out_.header = truth.header;
  out_.num_followers = truth.num_followers > 0 ? 1 : 0;
  out_.acceleration_mps2.clear();
  out_.safe_distance_m.clear();
  if (out_.num_followers == 0) return out_;

  const double speed_mps = truth.follower_speed_mps[0];
  const AccController::Output output = controller_.Step({
      .distance_m = truth.follower_gap_m[0],
      .relative_speed_mps = truth.host_speed_mps - speed_mps,
      .speed_mps = speed_mps,
      .acceleration_mps2 = truth.follower_acceleration_mps2[0],
      .has_target = true,
  });
  out_.acceleration_mps2.push_back(output.acceleration_mps2);
  out_.safe_distance_m.push_back(output.safe_distance_m);
  return out_;
}

}  // namespace fogline
