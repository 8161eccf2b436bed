// Commands to the world, as a test wants them.
#pragma once

#include "fogline/arbitration_t.hpp"
#include "fogline/follower_command_t.hpp"

namespace fogline {

inline arbitration_t HostCommand(double acceleration_mps2) {
  arbitration_t command{};
  command.acceleration_mps2 = acceleration_mps2;
  return command;
}

inline follower_command_t FollowerCommand(double acceleration_mps2) {
  follower_command_t command{};
  command.num_followers = 1;
  command.acceleration_mps2 = {acceleration_mps2};
  command.safe_distance_m = {0.0};
  return command;
}

}  // namespace fogline
