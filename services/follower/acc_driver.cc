#include "services/follower/acc_driver.h"

namespace fogline::follower {

DriverAction AccDriver::Step(const models::Situation& now) {
  const acc::AccController::Output output = controller_.Step({
      .distance_m = now.ahead->gap_m,
      .relative_speed_mps = now.ahead->speed_mps - now.speed_mps,
      .speed_mps = now.speed_mps,
      .acceleration_mps2 = now.acceleration_mps2,
      .has_target = true,
  });
  DriverAction action{output.acceleration_mps2, output.safe_distance_m};
  if (aeb_) {
    aeb_->Step(now);
    action.acceleration_mps2 = aeb_->Applied(action.acceleration_mps2);
  }
  return action;
}

}  // namespace fogline::follower
