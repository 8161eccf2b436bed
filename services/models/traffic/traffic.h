// Cars that another simulator (SUMO) moves, and the cars of Fogline among them. A position is the
// position of the front bumper along the lane, as in truth_t.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/models/vehicle/motion.h"

namespace fogline::models {

/// What the simulator of the other cars needs at the beginning of a run.
struct TrafficSetup {
  std::vector<std::string> net;     // lines of the network
  std::vector<std::string> routes;  // lines of the routes and cars
  std::string behind;               // car behind which the host begins
  double start_s = 0;               // time in the simulator at step 0
  std::int64_t step_us = 0;         // length of a step
  std::int64_t seed = 0;
  double host_gap_m = 0;  // gap at step 0, bumper to bumper
  double length_m = 0;    // length of every car of Fogline
};

/// The car ahead of the host.
struct LeaderInTraffic {
  double rear_m = 0;  // position of its rear bumper
  double speed_mps = 0;
  double acceleration_mps2 = 0;
  bool changed = false;  // whether the step before had another car ahead, or none
};

/// The simulator of the other cars, during a run. Begin() and Step() take the cars of Fogline from
/// front to back: first the host, then the following cars.
class Traffic {
 public:
  virtual ~Traffic() = default;

  /// Begins a run at step 0. Earlier runs have no effect: equal setups and equal cars give equal
  /// results. Returns the car ahead of the host.
  /// @param cars the host is at 0 m
  /// @throws InputError "/lead/sumo/...: message" if the cars have no place in the traffic
  virtual LeaderInTraffic Begin(std::span<const Motion> cars) = 0;

  /// Moves the other cars from step k to k + 1. The other cars react to the state of Fogline's cars
  /// at step k.
  /// @param cars the cars of Fogline at step k + 1
  /// @return the car ahead of the host at step k + 1; nullopt if the lane ahead is empty
  /// @throws std::runtime_error if the host leaves the road, or the simulator fails
  virtual std::optional<LeaderInTraffic> Step(std::span<const Motion> cars) = 0;

  /// Ends the run. Another run of this process can then begin.
  virtual void End() = 0;
};

}  // namespace fogline::models
