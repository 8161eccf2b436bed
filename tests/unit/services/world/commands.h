// Functions for tests of the world: they make commands, name the states of an input, and take TRUTH
// out of the output of World::Step().
#pragma once

#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "fogline/arbitration_t.hpp"
#include "fogline/follower_command_t.hpp"
#include "services/world/vehicle_fallback.h"
#include "services/world/world.h"

namespace fogline {

inline arbitration_t HostCommand(double acceleration_mps2) {
  arbitration_t command{};
  command.acceleration_mps2 = acceleration_mps2;
  return command;
}

inline follower_command_t FollowerCommands(std::vector<double> accelerations_mps2) {
  follower_command_t command{};
  command.num_followers = static_cast<std::int32_t>(accelerations_mps2.size());
  command.safe_distance_m.assign(accelerations_mps2.size(), 0.0);
  command.acceleration_mps2 = std::move(accelerations_mps2);
  return command;
}

inline follower_command_t FollowerCommand(double acceleration_mps2) {
  return FollowerCommands({acceleration_mps2});
}

inline constexpr InputState kOk = InputState::kOk;
inline constexpr InputState kStale = InputState::kStale;
inline constexpr InputState kLost = InputState::kLost;

inline const truth_t& Truth(const world::World::Output& output) {
  return std::get<truth_t>(output);
}

}  // namespace fogline
